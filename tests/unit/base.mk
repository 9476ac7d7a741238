UNIT_TESTS += test_base
test_base_SOURCES = tests/unit/test_base.c tests/unit/test.h tests/random.h
test_base_LDADD = $(unit_ldadd)
