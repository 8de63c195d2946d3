# Warnings are errors on our own code; what other projects' headers do is theirs (their includes are SYSTEM).
add_library(ricochet_warnings INTERFACE)
target_compile_options(ricochet_warnings INTERFACE -Wall -Wextra -Wpedantic -Wconversion -Werror)
