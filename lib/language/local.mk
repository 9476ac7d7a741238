libcore_la_SOURCES += \
  lib/language/expression.c \
  lib/language/formats.def \
  lib/language/importers.def \
  lib/language/functions.c \
  lib/language/functions.h \
  lib/language/foreign_syntax.c \
  lib/language/foreign_syntax.h \
  lib/language/lexer.c \
  lib/language/lexer.h \
  lib/language/operand.c \
  lib/language/parser.c \
  lib/language/parser.h \
  lib/language/quantity.c \
  lib/language/syntax_pattern.c \
  lib/language/statement.c \
  lib/language/syntax.h \
  lib/language/syntax_print.c \
  lib/language/verbs.c \
  lib/language/verbs.h \
  lib/language/verbs.def \
  lib/language/verbs_build.def \
  lib/language/verbs_look.def \
  lib/language/verbs_run.def \
  lib/language/verbs_session.def
