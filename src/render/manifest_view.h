/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The view in manifest.json: what is where in the pictures. Rectangles are [x, y, width, height] in pixels, y down.

   "view": {
     "panels": [
       {"rectangle": [46, 61, 570, 614], "runs": ["stack-engine.npz"], "scale": 36, "left": 195, "top": 596}, ...
     ],
     "parts": [
       {"part": "header", "rectangle": [0, 0, 1280, 49]},
       {"part": "caption", "panel": 0, "rectangle": [46, 34, 570, 26]}, ...
     ]
   }

   The point (X, Y) in metres is at pixel (x + left + scale * X, y + top - scale * Y) of the picture. `runs` are the files
   beside the manifest (trajectory_file_name): the first with filled boxes, the others as outlines. Parts are header,
   caption, axis, legend and timeline. With a moving camera, each picture has its own scale, left and top as "camera". */
#pragma once
#include "common/json_write.h"
#include "picture/picture.h"

void manifest_write_view(JsonWriter *json, const Picture *picture);

/* The members scale, left and top. */
void manifest_write_camera(JsonWriter *json, const Camera *camera);
