UNIT_TESTS += test_formulate
test_formulate_SOURCES = tests/unit/test_formulate.c tests/unit/test.h tests/unit/scene.h
test_formulate_LDADD = $(unit_ldadd)
