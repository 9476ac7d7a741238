# unit tests of lib/graph
