# Where things go: bin/, lib/seedframe/, share/seedframe/, share/doc/seedframe/, and where shells and
# man(1) look. The program finds its own relative to itself, so a tree of files can be moved as a whole.
include(GNUInstallDirs)
set(libraries_folder lib/seedframe)  # the program's own, so not that of an architecture
set(data_folder ${CMAKE_INSTALL_DATADIR}/seedframe)
set(doc_folder ${CMAKE_INSTALL_DATADIR}/doc/seedframe)

file(RELATIVE_PATH data_from_program /${CMAKE_INSTALL_BINDIR} /${data_folder})
file(RELATIVE_PATH libraries_from_program /${CMAKE_INSTALL_BINDIR} /${libraries_folder})
target_compile_definitions(seedframe_console PRIVATE
  SEEDFRAME_CHECKOUT="${PROJECT_SOURCE_DIR}"
  SEEDFRAME_BUILD_FOLDER="${PROJECT_BINARY_DIR}"
  SEEDFRAME_DATA_FROM_PROGRAM="${data_from_program}"
  SEEDFRAME_LIBRARIES_FROM_PROGRAM="${libraries_from_program}")

# Printed by each program that is linked, so that they say what it can do, and nothing else.
set(manual ${PROJECT_BINARY_DIR}/manual)
file(MAKE_DIRECTORY ${manual})
add_custom_command(TARGET seedframe POST_BUILD VERBATIM
  COMMAND seedframe manual bash > ${manual}/seedframe
  COMMAND seedframe manual zsh > ${manual}/_seedframe
  COMMAND seedframe manual fish > ${manual}/seedframe.fish
  COMMAND seedframe manual man > ${manual}/seedframe.1
  COMMAND gzip -9nkf ${manual}/seedframe.1)

install(TARGETS seedframe RUNTIME)
install(TARGETS seedframe_worker_cpu seedframe_image_module
        LIBRARY DESTINATION ${libraries_folder})
install(DIRECTORY blender_scripts assets materials configs DESTINATION ${data_folder}
        PATTERN __pycache__ EXCLUDE)
# As in a checkout, so that their links lead somewhere: to figures and configs too.
install(FILES README.md CONTRIBUTING.md LICENSE cmake/copyright DESTINATION ${doc_folder})
install(DIRECTORY docs DESTINATION ${doc_folder})
install(DIRECTORY results DESTINATION ${doc_folder} FILES_MATCHING
        PATTERN *.md PATTERN *.svg PATTERN *.jpg
        REGEX "results/[^/]*/(exports|frames|logs|report|work|audit)$" EXCLUDE)
file(RELATIVE_PATH configs_from_doc /${doc_folder} /${data_folder}/configs)
file(CREATE_LINK ${configs_from_doc} ${manual}/configs SYMBOLIC)
install(FILES ${manual}/configs DESTINATION ${doc_folder})
install(FILES ${manual}/seedframe DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions)
# Debian's zsh looks into the first below /usr/local, into the second below /usr.
foreach(folder site-functions vendor-completions)
  install(FILES ${manual}/_seedframe DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/${folder})
endforeach()
install(FILES ${manual}/seedframe.fish DESTINATION ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d)
install(FILES ${manual}/seedframe.1.gz DESTINATION ${CMAKE_INSTALL_MANDIR}/man1)
