// SPDX-License-Identifier: GPL-3.0-or-later
// A plain colour: most of a picture is background, painted with the cheapest shader.
#version 330 core

flat in vec4 fill;

out vec4 color;

void main() { color = fill; }
