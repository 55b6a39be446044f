/* SPDX-License-Identifier: GPL-3.0-or-later */
#pragma once

/* The processor's model, as the system names it, in plain characters of ASCII: "Intel(R) Xeon(R) CPU @ 2.20GHz"; else the
   architecture. */
enum { CPU_NAME_SIZE = 96 };
void cpu_name(char name[CPU_NAME_SIZE]);
