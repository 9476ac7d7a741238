# robots that are imported against a reader of their own; skipped where numpy isn't installed
TESTS += tests/oracle/urdf/robots_agree
EXTRA_DIST += tests/oracle/urdf
