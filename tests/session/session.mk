# scripts run by the real program
check_PROGRAMS += run-session
run_session_SOURCES = tests/session/run_session.c
TESTS += run-session
EXTRA_DIST += tests/session
