# The warnings every file of the project compiles clean under.
function(lacquer_warnings target)
  target_compile_options(${target} PRIVATE -Wall -Wextra -Wconversion -Wshadow)
  if(LACQUER_WERROR)
    target_compile_options(${target} PRIVATE -Werror)
  endif()
endfunction()
