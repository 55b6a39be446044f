# SPDX-License-Identifier: GPL-3.0-or-later
# Sourced: german COMMAND... runs it in de_DE.UTF-8, with its decimal comma, which is made in a folder.

# make_german FOLDER
make_german() {
    localedef -i de_DE -f UTF-8 "$1/de_DE.UTF-8" || { echo "localedef needs the Debian package locales"; return 1; }
    german_folder=$1
    [ "$(german bash -c 'printf %.1f 1,5')" = 1,5 ] || { echo "de_DE has no decimal comma"; return 1; }
}

german() { LOCPATH=$german_folder LC_ALL=de_DE.UTF-8 LANGUAGE=de "$@"; }
