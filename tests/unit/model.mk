# unit tests of lib/model
