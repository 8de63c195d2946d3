# cmake -DPROGRAM=… -DSOURCE=… -DVERSION=… -DOUTPUT=… [-DCOMPRESS=ON] -P: makes the manual page and the completion of
# shells. The program prints them, so that they always match its options. Leaks inside libraries are not checked here
# (builds with sanitizers).
set(ENV{ASAN_OPTIONS} detect_leaks=0)
macro(ask variable)
  execute_process(COMMAND ${PROGRAM} ${ARGN} OUTPUT_VARIABLE ${variable} COMMAND_ERROR_IS_FATAL ANY)
endmacro()

ask(COMMANDS manual-page)
string(STRIP "${COMMANDS}" COMMANDS)
configure_file(${SOURCE}/packaging/ricochet.1.in ${OUTPUT}/man/man1/ricochet.1 @ONLY)
if(COMPRESS)  # as packages require
  execute_process(COMMAND gzip -9nkf ${OUTPUT}/man/man1/ricochet.1 COMMAND_ERROR_IS_FATAL ANY)
endif()

foreach(shell bash zsh fish)
  ask(script completion ${shell})
  set(path_bash bash-completion/completions/ricochet)
  set(path_zsh zsh/vendor-completions/_ricochet)
  set(path_fish fish/vendor_completions.d/ricochet.fish)
  file(WRITE ${OUTPUT}/${path_${shell}} "${script}")
endforeach()
