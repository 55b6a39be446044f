# SPDX-License-Identifier: GPL-3.0-or-later
# The scripts that complete command lines: built in, and installed where the shells look for them.
set(completion_folder ${CMAKE_CURRENT_LIST_DIR}/completion)
twinbox_embed(twinbox_cli completion_scripts.c cli/completion_scripts.h char completion_ ${completion_folder}
              twinbox.bash _twinbox twinbox.fish)
install(FILES ${completion_folder}/twinbox.bash DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions
        RENAME twinbox)
install(FILES ${completion_folder}/twinbox.fish DESTINATION ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d)
# Debian's zsh looks into vendor-completions for packages, and into site-functions only below /usr/local. The prefix is known
# when it is installed.
install(CODE "set(zsh_folder site-functions)
              if(CMAKE_INSTALL_PREFIX MATCHES \"/usr$\")
                  set(zsh_folder vendor-completions)
              endif()
              file(INSTALL ${completion_folder}/_twinbox
                   DESTINATION \${CMAKE_INSTALL_PREFIX}/${CMAKE_INSTALL_DATADIR}/zsh/\${zsh_folder})")

# The scenes that `twinbox new` writes, so that it works from any folder.
twinbox_embed(twinbox_cli templates.c cli/templates.h char template_ ${PROJECT_SOURCE_DIR}/scenes/templates
              wall.yaml stack.yaml pyramid.yaml arch.yaml dominoes.yaml)
