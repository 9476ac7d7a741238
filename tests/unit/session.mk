# unit tests of lib/export and of the public interface
UNIT_TESTS += test_session test_session_look
test_session_SOURCES = tests/unit/test_session.c tests/unit/session_kit.h tests/unit/test.h
test_session_LDADD = $(unit_ldadd)
test_session_look_SOURCES = tests/unit/test_session_look.c tests/unit/session_kit.h tests/unit/test.h
test_session_look_LDADD = $(unit_ldadd)
UNIT_TESTS += test_session_run
test_session_run_SOURCES = tests/unit/test_session_run.c tests/unit/session_kit.h tests/unit/test.h
test_session_run_LDADD = $(unit_ldadd)
UNIT_TESTS += test_session_help test_export
test_session_help_SOURCES = tests/unit/test_session_help.c tests/unit/session_kit.h tests/unit/test.h
test_session_help_LDADD = $(unit_ldadd)
test_export_SOURCES = tests/unit/test_export.c tests/unit/session_kit.h tests/unit/test.h
test_export_LDADD = $(unit_ldadd)
UNIT_TESTS += test_session_trees
test_session_trees_SOURCES = tests/unit/test_session_trees.c tests/unit/session_kit.h tests/unit/test.h
test_session_trees_LDADD = $(unit_ldadd)
