# unit tests of lib/expr
