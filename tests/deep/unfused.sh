# SPDX-License-Identifier: GPL-3.0-or-later
# unfused COMMAND...: runs it as on a CPU without fused multiply-add, as far as glibc is concerned.
unfused() { GLIBC_TUNABLES=glibc.cpu.hwcaps=-FMA,-FMA4,-FMA_Usable,-FMA4_Usable "$@"; }
