# SPDX-License-Identifier: GPL-3.0-or-later
# Improves what cmark-gfm writes: tables that fit 80 columns, fonts that every terminal has, examples.
BEGIN {
    after_heading = 1 # one stands before the page
    line_width = 66   # characters of a table, of 80 without the indent
}

function fonts(text) {
    gsub(/\\f\[C\]/, "\\fB", text)
    gsub(/\\f\[B\]/, "\\fB", text)
    gsub(/\\f\[I\]/, "\\fI", text)
    gsub(/\\f\[\]/, "\\fR", text)
    return text
}

# Characters of a cell as it is shown.
function width_of(text) {
    gsub(/\\f\[[A-Z]*\]/, "", text)
    gsub(/\\./, "x", text)
    return length(text)
}

function longest_word(text,    count, words, i, most) {
    count = split(text, words, " ")
    for (i = 1; i <= count; i++) if (width_of(words[i]) > most) most = width_of(words[i])
    return most
}

# Columns that are too wide together share what the narrow ones leave, by the square roots of their widths. But a column has
# room for its longest word.
function find_widths(columns,    i, all, long, left) {
    left = line_width - 3 * (columns - 1) # without the gaps
    for (i = 1; i <= columns; i++) {
        wraps[i] = 0
        if (widest[i] <= 14) {
            left -= widest[i]
            continue
        }
        all += widest[i]
        long += sqrt(widest[i])
    }
    if (all <= left) return
    for (i = 1; i <= columns; i++) {
        if (widest[i] <= 14) continue
        wraps[i] = int(left * sqrt(widest[i]) / long)
        if (wraps[i] > widest[i]) wraps[i] = widest[i]
        if (wraps[i] < longest[i]) wraps[i] = longest[i]
        left -= wraps[i]
        long -= sqrt(widest[i])
    }
}

function print_table(    i, k, head, format, line, count, cells, text) {
    find_widths(columns)
    for (k = 1; k <= columns; k++) {
        text = wraps[k] > 0 ? "w(" wraps[k] "n)" : ""
        head = head (k > 1 ? " " : "") "lb" text
        format = format (k > 1 ? " " : "") "l" text
    }
    print (after_heading ? "" : ".PP\n") ".TS\ntab(@);\n" head "\n" format "."
    for (i = 1; i <= rows; i++) {
        count = split(row[i], cells, "@")
        line = ""
        for (k = 1; k <= columns; k++) {
            text = k <= count ? fonts(cells[k]) : ""
            if (text ~ /^[.']/) text = "\\&" text
            if (wraps[k] > 0 && text != "") text = "T{\n" text "\nT}"
            line = line (k > 1 ? "@" : "") text
        }
        print line
    }
    print ".TE"
}

/^\.TS/ { table = 1; rows = 0; next }
/^\.TE/ { table = 0; print_table(); after_heading = 0; next }
table == 1 { table = 2; next } # tab(@);
table == 2 {
    columns = length($0) - 1
    for (i = 1; i <= columns; i++) widest[i] = longest[i] = 0
    table = 3
    next
}
table == 3 {
    row[++rows] = $0
    count = split($0, cells, "@")
    for (i = 1; i <= count; i++) {
        if (width_of(cells[i]) > widest[i]) widest[i] = width_of(cells[i])
        if (longest_word(cells[i]) > longest[i]) longest[i] = longest_word(cells[i])
    }
    next
}

# Code: .IP .nf \f[C] ... \f[] .fi
/^\.IP$/ { held = 1; next }
held && /^\.nf$/ { held = 0; code = 1; print (after_heading ? "" : ".PP\n") ".RS 4\n.EX"; after_heading = 0; next }
held { print ".IP"; held = 0 }
code && /^\\f\[C\]$/ { next }
code && /^\\f\[\]$/ { next }
code && /^\.fi$/ { code = 0; print ".EE\n.RE"; next }
code { sub(/^[.']/, "\\\\\\&&"); print; next }

/^\.S[HS]$/ { heading = $0; next }
heading != "" { print heading " " fonts($0); heading = ""; after_heading = 1; next }
after_heading && /^\.PP$/ { after_heading = 0; next }
{ after_heading = 0; print fonts($0) }
