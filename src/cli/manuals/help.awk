# SPDX-License-Identifier: GPL-3.0-or-later
# Reads the help of a command. Prints it in the form that help2man reads best or, with part=include, the synopsis and the
# examples as sections for help2man's option --include.
BEGIN { state = "usage" }

function roff(text) {
    gsub(/\\/, "\\e", text)
    gsub(/-/, "\\-", text)
    return text
}

# "[OPTION...] --kind NAME": placeholders are in italics, what is typed as it stands is bold.
function synopsis(text, out, word) {
    while (match(text, /[A-Za-z0-9_.-]+/)) {
        out = out substr(text, 1, RSTART - 1)
        word = substr(text, RSTART, RLENGTH)
        text = substr(text, RSTART + RLENGTH)
        dots = ""
        if (match(word, /\.\.\.$/)) { dots = "..."; word = substr(word, 1, RSTART - 1) }
        if (word ~ /^[A-Z][A-Z_]*(\.[a-z]+)?$/) out = out "\\fI" word "\\fR" dots
        else if (word != "") out = out "\\fB" roff(word) "\\fR" dots
        else out = out dots
    }
    return out text
}

# Usage: twinbox NAME ..., then further forms.
state == "usage" && /^(Usage| *or):/ {
    line = $0
    sub(/^(Usage| *or): +/, "", line)
    sub(/ +$/, "", line)
    if (part == "include") {
        if (!forms++) print "[=SYNOPSIS]"; else print ".br"
        print synopsis(line)
    } else if (/^Usage/) print
    next
}
state == "usage" { state = "text"; if (part == "include") print "" }

/^Mandatory or optional arguments/ { next }
/^(Example|Begin with):/ {
    state = "examples"
    if (part == "include") print "[EXAMPLES]\n.EX"
}
state == "examples" {
    if (part != "include") next
    sub(/^(Example:|Begin with:|        ) /, "")
    $0 = roff($0)
    sub(/^[.']/, "\\\\\\&&")
    print
    next
}
/^Exit status:/ { state = "exit" }
part == "include" || state == "exit" { next }

/^ +-/ && state == "text" { state = "options"; print "\nOptions:\n" }
state == "options" && /^ +-\?, --help/ && headings { print "\nIn all commands:" }
# A heading above commands.
state == "text" && /^[A-Z][a-z ]*:$/ { print "" }
# A heading above options, with or without a sentence.
state != "usage" && /^ [A-Za-z]/ {
    if (state == "text") { state = "options"; print "\nOptions:\n" }
    headings++
    line = substr($0, 2)
    at = index(line, ": ")
    if (at > 0) print substr(line, 1, at) "\n  " substr(line, at + 2) "\n"
    else print line
    next
}
{ print }
END { if (part == "include" && state == "examples") print ".EE\n" }
