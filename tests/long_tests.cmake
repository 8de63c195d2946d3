# Tests with the label "long": `./dev test` leaves them to `./dev test --all`. They repeat at length what shorter tests
# check once, or compare with the world outside. Every case, benchmark, tutorial and random case is one, and these:
set(RICOCHET_LONG_TESTS
  # as long as a user's work
  end_to_end.hertz end_to_end.throws end_to_end.scenes end_to_end.random_cases python.examples
  # kill -9 at random moments, signals at any moment, and the same bits everywhere
  end_to_end.vtkhdf_interrupted end_to_end.signals python.same_bits
  # other forms of what is tested: sizes of pictures, packages
  end_to_end.plot end_to_end.animation end_to_end.installation python.wheel
  # orders of convergence on many meshes, and schemes that are not defaults, for long
  verification.follower_pressure verification.published_schemes verification.elements.manufactured_solution
  verification.locking verification.contact.inf_sup end_to_end.adaptive_steps)

# Tests that measure times have the label "timed" and run alone. `./dev faults` and `./dev coverage` leave them out.
set(RICOCHET_TIMED_TESTS end_to_end.step_price end_to_end.signals python.overhead)

include(${CMAKE_CURRENT_LIST_DIR}/sanitized_tests.cmake)

foreach(name ${RICOCHET_LONG_TESTS} ${RICOCHET_TIMED_TESTS} ${RICOCHET_SANITIZE_TESTS})
  if(NOT name MATCHES "^(unit|verification|allocations|end_to_end|python)[.]")
    message(FATAL_ERROR "tests/long_tests.cmake and tests/sanitized_tests.cmake: ${name} begins with no folder of tests")
  endif()
endforeach()

# ricochet_label_test(NAME LABELS…): gives an entry these labels and those of the lists.
function(ricochet_label_test name)
  set(labels ${ARGN})
  foreach(label long timed sanitize)
    string(TOUPPER ${label} list)
    if(name IN_LIST RICOCHET_${list}_TESTS)
      list(APPEND labels ${label})
    endif()
  endforeach()
  set_tests_properties(${name} PROPERTIES LABELS "${labels}")
  if("timed" IN_LIST labels)
    set_tests_properties(${name} PROPERTIES RUN_SERIAL ON)
  endif()
endfunction()

# ricochet_require_listed_tests(PREFIX): an error unless the entries of the lists that begin with PREFIX are tests of this
# folder.
function(ricochet_require_listed_tests prefix)
  foreach(name ${RICOCHET_LONG_TESTS} ${RICOCHET_TIMED_TESTS} ${RICOCHET_SANITIZE_TESTS})
    if(name MATCHES "^${prefix}" AND NOT TEST ${name})
      message(FATAL_ERROR "tests/long_tests.cmake and tests/sanitized_tests.cmake: there is no test ${name}")
    endif()
  endforeach()
endfunction()
