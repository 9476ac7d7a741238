# unit tests of lib/simulate
UNIT_TESTS += test_simulate_linear
test_simulate_linear_SOURCES = tests/unit/test_simulate_linear.c tests/unit/test.h
test_simulate_linear_LDADD = $(unit_ldadd)
