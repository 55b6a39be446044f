/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The scenes of scenes/templates/, embedded in the binary (sources.cmake lists them, too). */
#pragma once

#define TEMPLATES(TEMPLATE) TEMPLATE(wall) TEMPLATE(stack) TEMPLATE(pyramid) TEMPLATE(arch) TEMPLATE(dominoes)

#define TEMPLATE_DECLARED(name) extern const char template_##name##_yaml[];
TEMPLATES(TEMPLATE_DECLARED)
#undef TEMPLATE_DECLARED
