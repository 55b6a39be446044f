# SPDX-License-Identifier: GPL-3.0-or-later
# help2man fills indented lines of a description as it fills text. They are code: each stays a line.
/^\.SH/ { description = /DESCRIPTION/ }
description && /^\.IP$/ { code = 1; print ".PP\n.RS 4\n.EX"; next }
code && /^\.(PP|SH)/ { code = 0; print ".EE\n.RE" }
{ print }
