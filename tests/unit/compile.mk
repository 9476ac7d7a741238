# unit tests of lib/compile
UNIT_TESTS += test_program
test_program_SOURCES = tests/unit/test_program.c tests/unit/test.h
test_program_LDADD = $(unit_ldadd)
UNIT_TESTS += test_lowered
test_lowered_SOURCES = tests/unit/test_lowered.c tests/unit/test.h
test_lowered_LDADD = $(unit_ldadd)
UNIT_TESTS += test_residual
test_residual_SOURCES = tests/unit/test_residual.c tests/unit/test.h
test_residual_LDADD = $(unit_ldadd)
UNIT_TESTS += test_threads
test_threads_SOURCES = tests/unit/test_threads.c tests/unit/test.h
test_threads_LDADD = $(unit_ldadd)
