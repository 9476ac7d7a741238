# unit tests of lib/simulate
UNIT_TESTS += test_simulate_linear test_simulate_march
test_simulate_linear_SOURCES = tests/unit/test_simulate_linear.c tests/unit/test.h
test_simulate_linear_LDADD = $(unit_ldadd)
test_simulate_march_SOURCES = tests/unit/test_simulate_march.c tests/unit/simulate_problems.h \
  tests/unit/test.h
test_simulate_march_LDADD = $(unit_ldadd)
