/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Frames of an earlier sequence in the folder, which could be mistaken for frames of this one. */
#pragma once
#include "render/manifest.h"

/* Removes the frames that the folder's manifest or journal lists, that the new sequence does not overwrite, and whose
   bytes are unchanged; files of any other origin stay. To be called while both are still those of the earlier sequence: what
   an interrupted call leaves is then listed for the next one. ERROR_SYSTEM if one of them is left. */
bool stale_remove(const Manifest *manifest, Error *error);
