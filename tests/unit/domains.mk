# unit tests of the scalar domains beside circuits
UNIT_TESTS += test_domains
test_domains_SOURCES = tests/unit/test_domains.c tests/unit/session_kit.h tests/unit/test.h
test_domains_LDADD = $(unit_ldadd)
