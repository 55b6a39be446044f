/* SPDX-License-Identifier: GPL-3.0-or-later */
#pragma once
#include <stddef.h>
#include <stdio.h>

/* Bytes as base64 (RFC 4648). Own code: none of the libraries in use encodes it. */
void base64_put(FILE *file, const void *data, size_t size);
