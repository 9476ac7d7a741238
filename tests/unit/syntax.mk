# unit tests of lib/model/syntax.h
UNIT_TESTS += test_syntax test_syntax_print test_syntax_verbs test_syntax_wrong
test_syntax_SOURCES = tests/unit/test_syntax.c tests/unit/test.h
test_syntax_LDADD = $(unit_ldadd)
test_syntax_print_SOURCES = tests/unit/test_syntax_print.c tests/unit/test.h
test_syntax_print_LDADD = $(unit_ldadd)
test_syntax_verbs_SOURCES = tests/unit/test_syntax_verbs.c tests/unit/test.h
test_syntax_verbs_LDADD = $(unit_ldadd)
test_syntax_wrong_SOURCES = tests/unit/test_syntax_wrong.c tests/unit/test.h tests/unit/wrong.h
test_syntax_wrong_LDADD = $(unit_ldadd)
EXTRA_DIST += tests/session/wrong.txt
UNIT_TESTS += test_syntax_model
test_syntax_model_SOURCES = tests/unit/test_syntax_model.c tests/unit/test.h tests/unit/wrong.h
test_syntax_model_LDADD = $(unit_ldadd)
