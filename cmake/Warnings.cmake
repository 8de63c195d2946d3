# Warnings are errors in our own code; headers of other projects are exempt (their includes are SYSTEM).
add_library(ricochet_warnings INTERFACE)
target_compile_options(ricochet_warnings INTERFACE -Wall -Wextra -Wpedantic -Wconversion -Werror)
