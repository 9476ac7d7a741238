# unit test of the joints
UNIT_TESTS += test_joints
test_joints_SOURCES = tests/unit/test_joints.c tests/unit/test_model.h tests/unit/test.h
test_joints_LDADD = $(unit_ldadd)
