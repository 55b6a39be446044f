# SPDX-License-Identifier: GPL-3.0-or-later
# The scenes that `twinbox new` writes, so that it works from any folder.
twinbox_embed(twinbox_cli templates.c cli/templates.h char template_ ${PROJECT_SOURCE_DIR}/scenes/templates
              wall.yaml stack.yaml pyramid.yaml arch.yaml dominoes.yaml)
