// SPDX-License-Identifier: GPL-3.0-or-later
// One colour: most of a picture is background, and cheap.
#version 330 core

flat in vec4 fill;

out vec4 color;

void main() { color = fill; }
