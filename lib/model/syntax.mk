# text to statements
libcore_la_SOURCES += lib/model/lexer.h lib/model/habits.c lib/model/habits.h lib/model/lexer.c lib/model/parser.h lib/model/parser.c \
	lib/model/expression.c lib/model/quantity.c lib/model/operand.c lib/model/shape.c \
	lib/model/statement.c lib/model/syntax_print.c lib/model/verbs.h lib/model/verbs.c \
	lib/model/verbs_build.c lib/model/verbs_look.c lib/model/verbs_run.c \
	lib/model/verbs_session.c lib/model/verbs_later.c
