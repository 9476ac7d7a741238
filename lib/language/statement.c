/* statement.c: texts to statements
 *
 * statement = NAME "=" expr
 *           | NAME "(" NAME { "," NAME } ")" "=" expr
 *           | "?" [ WORD ]
 *           | [ "virtual" ] VERB { operand [ "," ] } { pair [ "," ] } [ ":" statement ]
 *             [ redirect ] ; */
#include "component/component.h"
#include "language/foreign_syntax.h"
#include "language/parser.h"
#include "language/verbs.h"

#include <string.h>

/* --- verbs --- */

static Status ambiguous_verb(const Parser *parser, const Token *token)
{
    size_t length = strlen(token->text);
    Text list = {0};
    Verb verb;

    for (int i = 0; verb_at(i, &verb); i++)
        if (strncmp(verb.name, token->text, length) == 0)
            text_addf(&list, "%s%s", list.length > 0 ? ", " : "", verb.name);
    (void)diag_at(parser->diag, E_NAME, token->place, "'%s' is ambiguous: %s", token->text,
                  list.at);
    diag_hint(parser->diag, "write a letter more");
    text_free(&list);
    return E_NAME;
}

/* How many verbs start so; *verb is the last of them. */
static int find_shortened(const char *word, Verb *verb)
{
    int count = 0;
    Verb row;

    for (int i = 0; verb_any(i, &row); i++)
        if (strncmp(row.name, word, strlen(word)) == 0) {
            *verb = row;
            count++;
        }
    return count;
}

/* x := 3, x == 3, x += 3 */
static bool is_assignment(const Parser *parser)
{
    const Token *sign = parser_peek(parser, 1);

    return token_is(sign, "==") || (strchr(":+-*/", sign->text[0]) != NULL &&
                                    sign->text[0] != '\0' && token_is(parser_peek(parser, 2), "="));
}

/* which verb it may have been meant for, as a hint; false: none */
static bool hint_verb(const Parser *parser, const Token *token, Diag *diag)
{
    Suggest suggest = suggest_for(token->text);
    const Token *following = parser_peek(parser, 1);
    Verb verb;

    for (int i = 0; verb_any(i, &verb); i++)
        suggest_offer(&suggest, verb.name);
    if (is_assignment(parser))
        diag_hint(diag, "a parameter is written %s = ...", token->text);
    else if (foreign_syntax_hint(FOREIGN_VERB, token->text) != NULL)
        diag_hint(diag, "%s", foreign_syntax_hint(FOREIGN_VERB, token->text));
    else if (following->kind == TOKEN_SYMBOL && strcmp(following->text, "(") == 0 &&
             !following->touches)
        diag_hint(diag, "the bracket of a law touches its name: %s(x) = ...", token->text);
    else if (!parser->options.shortened && find_shortened(token->text, &verb) == 1)
        diag_hint(diag, "a script spells words out: '%s'", verb.name);
    else if (suggest.best != NULL)
        diag_hint(diag, "did you mean '%s'?", suggest.best);
    else
        return false;
    return true;
}

static Status unknown_verb(const Parser *parser, const Token *token)
{
    (void)diag_at(parser->diag, E_NAME, token->place, "unknown command '%s'", token->text);
    if (!hint_verb(parser, token, parser->diag))
        diag_hint(parser->diag, "'help' lists the commands; to see a value: print %s", token->text);
    return E_NAME;
}

static Status find_verb(Parser *parser, const Token *token, Verb *verb)
{
    Verb found;
    int count;

    if (verb_find(token->text, verb))
        return OK;
    if (!parser->options.shortened)
        return unknown_verb(parser, token);
    count = find_shortened(token->text, &found);
    if (count == 0)
        return unknown_verb(parser, token);
    if (count > 1)
        return ambiguous_verb(parser, token);
    *verb = found;
    return OK;
}

static Status parse_verb(Parser *parser, Statement *statement)
{
    const Token *token = parser_token(parser);

    TRY(find_verb(parser, token, &statement->row));
    parser->at++;
    if (statement->row.room == ROOM_LANGUAGE) {
        token = parser_token(parser);
        if (token->kind != TOKEN_PATH) {
            (void)parser_expected(parser, "a joint's keyword");
            diag_hint(parser->diag, "usage: %s", statement->row.usage);
            return E_SYNTAX;
        }
        TRY(find_verb(parser, token, &statement->row));
        parser->at++;
        if (statement->row.component == NULL || statement->row.component->family != FAMILY_JOINT) {
            (void)diag_at(parser->diag, E_SYNTAX, token->place, "'%s' can't be virtual",
                          token->text);
            diag_hint(parser->diag, "only joints can, as in: virtual revolute vh16 m1 m3");
            return E_SYNTAX;
        }
        statement->is_virtual = true;
    }
    statement->kind = STATEMENT_VERB;
    statement->verb = statement->row.name;
    statement->verb_place = token->place;
    return parse_pattern(parser, statement);
}

/* "?" [ WORD ] */
static Status parse_question(Parser *parser, Statement *statement)
{
    statement->kind = STATEMENT_VERB;
    statement->row = verb_row(VERB_help);
    statement->verb = statement->row.name;
    statement->verb_place = parser_token(parser)->place;
    parser->at++;
    return parse_pattern(parser, statement);
}

/* --- definitions --- */

static bool is_function(const char *name)
{
    static const char *const more[] = {"pulse", "pwl", "table", "mean", "rms", "normal", "uniform"};
    static const char *const operations[] = {
#define OP(id, text, ...) text,
#include "expr/ops.def"
#undef OP
    };

    for (int i = 0; i < COUNT(operations); i++)
        if (strcmp(name, operations[i]) == 0)
            return true;
    for (int i = 0; i < COUNT(more); i++)
        if (strcmp(name, more[i]) == 0)
            return true;
    return false;
}

/* the tokens between a name and "=" of `NAME ( ... ) =`; 0: it is no law */
static int law_length(const Parser *parser)
{
    int n = 1;

    if (parser_peek(parser, 1)->text[0] != '(' || parser_peek(parser, 1)->kind != TOKEN_SYMBOL ||
        !parser_peek(parser, 1)->touches)
        return 0;
    while (parser_peek(parser, n)->kind != TOKEN_END &&
           strcmp(parser_peek(parser, n)->text, ")") != 0)
        n++;
    return parser_peek(parser, n + 1)->kind == TOKEN_SYMBOL &&
                   strcmp(parser_peek(parser, n + 1)->text, "=") == 0
               ? n
               : 0;
}

static Status check_defined_name(const Parser *parser, const Token *name, bool law)
{
    Text usage = {0};
    Verb verb;

    if (verb_find(name->text, &verb)) {
        verb_usage(&usage, &verb);
        (void)diag_at(parser->diag, E_NAME, name->place, "'%s' is a command and can't be a %s",
                      name->text, law ? "law" : "parameter");
        diag_hint(parser->diag, "as a command: %s", usage.at != NULL ? usage.at : verb.name);
        text_free(&usage);
        return E_NAME;
    }
    if (law && is_function(name->text)) {
        (void)diag_at(parser->diag, E_NAME, name->place, "'%s' is a function and can't be a law",
                      name->text);
        diag_hint(parser->diag, "choose another name");
        return E_NAME;
    }
    return parser_check_reserved(parser, name);
}

static Status parse_definition_value(Parser *parser, Statement *statement)
{
    TRY(parse_expression(parser, &statement->value));
    if (parser_ends(parser))
        return OK;
    if (parser_sees(parser, ">") || parser_sees(parser, ">>")) {
        (void)diag_at(parser->diag, E_SYNTAX, parser_token(parser)->place,
                      "a definition prints nothing that could go to a file");
        diag_hint(parser->diag, "to see its value: print %s", statement->name);
        return E_SYNTAX;
    }
    (void)parser_unexpected(parser);
    if (parser_sees_pair(parser))
        diag_hint(parser->diag, "statements on one line stand between ';'");
    else if (parser_token(parser)->kind == TOKEN_PATH)
        diag_hint(parser->diag, "a product needs its *");
    return E_SYNTAX;
}

/* NAME "=" expr */
static Status parse_parameter(Parser *parser, Statement *statement)
{
    const Token *name;

    TRY(parse_name(parser, &name));
    TRY(check_defined_name(parser, name, false));
    statement->kind = STATEMENT_PARAMETER;
    statement->name = name->text;
    statement->name_place = name->place;
    parser->at++;
    return parse_definition_value(parser, statement);
}

/* NAME "(" NAME { "," NAME } ")" "=" expr */
static Status parse_law(Parser *parser, Statement *statement)
{
    int room = law_length(parser);
    const Token *name;

    TRY(parse_name(parser, &name));
    TRY(check_defined_name(parser, name, true));
    statement->kind = STATEMENT_LAW;
    statement->name = name->text;
    statement->name_place = name->place;
    statement->arguments = pool_alloc(parser->pool, (size_t)room * sizeof(char *));
    parser->at++;
    if (parser_sees(parser, ")")) {
        (void)parser_expected(parser, "an argument");
        diag_hint(parser->diag, "without arguments it is a parameter: %s = ...", name->text);
        return E_SYNTAX;
    }
    do {
        const Token *argument;

        TRY(parse_name(parser, &argument));
        for (int i = 0; i < statement->argument_count; i++)
            if (strcmp(statement->arguments[i], argument->text) == 0)
                return diag_at(parser->diag, E_NAME, argument->place, "'%s' is there twice",
                               argument->text);
        statement->arguments[statement->argument_count++] = argument->text;
    } while (parser_accept(parser, ","));
    if (!parser_accept(parser, ")"))
        TRY(parser_expected(parser, "',' or ')'"));
    parser->at++;
    return parse_definition_value(parser, statement);
}

/* x.y = ..., x' = ...: which verb was meant */
static Status refuse_pair(Parser *parser)
{
    const Token *token = parser_token(parser);
    bool primes = parser_peek(parser, 1)->kind == TOKEN_PRIMES;
    Place place =
        primes ? place_between(token->place, parser_peek(parser, 1)->place) : token->place;
    const char *p = primes ? parser_peek(parser, 1)->text : "";

    (void)diag_at(parser->diag, E_SYNTAX, place, "'%s%s' can't be defined", token->text, p);
    if (primes)
        diag_hint(parser->diag, "an initial value is given by: init %s%s = ...", token->text, p);
    else
        diag_hint(parser->diag,
                  "an initial value is given by: init %s = ...; a part's key by: set %s = ...",
                  token->text, token->text);
    return E_SYNTAX;
}

/* --- an expression alone, which is printed --- */

/* Whether the tokens after a word that is no command continue an expression. */
static bool sees_rest_of_expression(const Parser *parser)
{
    static const char *const signs[] = {"+",  "-",  "*",  "/",  "^",  "<", ">",
                                        "<=", ">=", "!=", "&&", "||", ",", "["};
    const Token *next = parser_peek(parser, 1);
    bool any = next->kind == TOKEN_END || next->kind == TOKEN_PRIMES ||
               (next->kind == TOKEN_PATH && strcmp(next->text, "at") == 0) ||
               (token_is(next, "(") && next->touches);

    for (int i = 0; !any && i < COUNT(signs); i++)
        any = token_is(next, signs[i]);
    return any && !is_assignment(parser);
}

static bool sees_expression(const Parser *parser)
{
    const Token *first = parser_token(parser);
    Verb verb;

    if (parser->at > 0) /* `time` and `sweep` run statements */
        return false;
    if (first->kind != TOKEN_PATH)
        return first->kind == TOKEN_NUMBER || token_is(first, "(") || token_is(first, "-");
    if (strchr(first->text, '.') != NULL)
        return true;
    return !verb_find(first->text, &verb) && sees_rest_of_expression(parser) &&
           !(parser->options.shortened && find_shortened(first->text, &verb) == 1);
}

static Status parse_printed(Parser *parser, Statement *statement)
{
    const Token *first = parser_token(parser);
    Diag *const diag = parser->diag;

    /* a mistyped command is a name, too: the model knows */
    if (first->kind == TOKEN_PATH && strchr(first->text, '.') == NULL &&
        !token_is(parser_peek(parser, 1), "(") && !name_is_reserved(first->text)) {
        Diag *unknown = pool_alloc(parser->pool, sizeof *unknown);
        Verb verb;

        *unknown = (Diag){0};
        parser->diag = unknown;
        (void)find_verb(parser, first, &verb);
        parser->diag = diag;
        if (!hint_verb(parser, first, NULL) &&
            !(parser->options.shortened && find_shortened(first->text, &verb) > 1))
            unknown->hint[0] = '\0';
        statement->unknown = unknown;
    }
    statement->kind = STATEMENT_VERB;
    statement->row = verb_row(VERB_print);
    statement->verb = statement->row.name;
    statement->verb_place = first->place;
    return parse_pattern(parser, statement);
}

static Status refuse_start(Parser *parser)
{
    (void)diag_at(parser->diag, E_SYNTAX, parser_token(parser)->place,
                  "a statement starts with a word");
    if (parser_sees(parser, "!"))
        diag_hint(parser->diag, "there is no way to a system shell");
    else
        diag_hint(parser->diag, "to see a value: print ...");
    return E_SYNTAX;
}

static Status parse_statement(Parser *parser, Statement *statement)
{
    const Token *first = parser_token(parser);

    if (parser_sees(parser, "?"))
        TRY(parse_question(parser, statement));
    else if (first->kind != TOKEN_PATH && !sees_expression(parser))
        TRY(refuse_start(parser));
    else if (parser_sees_pair(parser)) {
        if (strchr(first->text, '.') != NULL || parser_peek(parser, 1)->kind == TOKEN_PRIMES)
            TRY(refuse_pair(parser));
        TRY(parse_parameter(parser, statement));
    } else if (law_length(parser) > 0)
        TRY(parse_law(parser, statement));
    else if (sees_expression(parser))
        TRY(parse_printed(parser, statement));
    else
        TRY(parse_verb(parser, statement));

    const Token *last = parser_before(parser);
    int *offsets = pool_alloc(parser->pool,
                              sizeof *offsets * (size_t)(last->place.line - first->place.line + 1));

    offsets[0] = -first->place.column;
    statement->text = text_slice(parser->pool, parser->text, first->start, last->end, offsets + 1);
    statement->offsets = offsets;
    statement->place = place_between(first->place, last->place);
    return OK;
}

/* --- the text --- */

/* l: the rest of the line belongs to the statement unchanged */
static bool takes_line(Lexer lexer, Verb *verb, Token *token)
{
    return lexer_next(&lexer, token, NULL) == OK && token->kind == TOKEN_PATH &&
           verb_find(token->text, verb) && strcmp(verb->pattern, "l") == 0;
}

static void parse_line(Parser *parser, Lexer *lexer, const Verb *verb, const Token *token,
                       Statement *statement)
{
    lexer_skip_line(lexer);

    size_t end = lexer->at;
    size_t start = token->end < end ? token->end + 1 : end;
    Syntax *line = pool_alloc(parser->pool, sizeof *line);
    Place place = token->place;

    place.column += token->place.width + 1;
    place.width = end > start ? (int)(end - start) : 1;
    *line = (Syntax){.kind = SYNTAX_STRING,
                     .text = text_slice(parser->pool, parser->text, start, end, NULL),
                     .unit_text = "",
                     .height = 1,
                     .place = place,
                     .op_place = place};
    LIST_PUSH(statement->operands, (Operand){0, line, place});
    statement->kind = STATEMENT_VERB;
    statement->verb = verb->name;
    statement->row = *verb;
    statement->verb_place = token->place;
    statement->place = token->place;
    statement->text = text_slice(parser->pool, parser->text, token->start, end, NULL);
    lexer_skip_breaks(lexer);
}

/* The statements of a definition's lines, up to the first fault. */
static const Body *parse_body(const char *text, Pool *pool)
{
    Body *body = pool_alloc(pool, sizeof *body);
    size_t lines = 1;
    Statement *at;

    for (const char *c = text; *c != '\0'; c++)
        lines += *c == '\n';
    at = pool_alloc(pool, sizeof *at * lines);
    *body = (Body){.text = text, .at = at};
    for (int number = 2; *text != '\0' && body->fault == NULL; number++) {
        const size_t length = strcspn(text, "\n");
        char *line = mem_text(text, length);
        Statement *statement = NULL;
        Diag fault = {0};

        if (statement_parse(line, number, (SyntaxOptions){false}, NULL, &statement, &fault) != OK) {
            Diag *first = pool_alloc(pool, sizeof *first);

            *first = fault;
            body->fault = first;
        } else if (statement->kind != STATEMENT_EMPTY)
            statement_copy(pool, statement, &at[body->count++]);
        statement_free(statement);
        mem_free(line);
        text += length + (text[length] == '\n');
    }
    return body;
}

/* The lines of a subsystem that starts there, up to its end, which is a line of its own. */
static Status read_body(Statement *statement, Lexer *lexer, const char *text, size_t start,
                        Diag *diag)
{
    const char *const body = text + lexer->at;
    const char *line = body;
    size_t length;

    for (;; line += length + 1) {
        length = strcspn(line, "\n");
        if (strncmp(line, "end", 3) == 0 && strspn(line + 3, " \t") + 3 == length)
            break;
        if (line[length] == '\0')
            return diag_at(diag, E_SYNTAX, statement->place, "the subsystem has no end");
        lexer->line++;
    }
    statement->body =
        parse_body(pool_text(statement->pool, body, (size_t)(line - body)), statement->pool);
    lexer->at = (size_t)(line - text) + length;
    statement->text = pool_text(statement->pool, text + start, lexer->at - start);
    lexer_skip_breaks(lexer);
    return OK;
}

Status statement_read(Cursor *cursor, SyntaxOptions options, Statement **out, Diag *diag)
{
    Statement *statement = NEW(Statement);
    Pool *pool = pool_new(4096);
    Lexer lexer = lexer_start(cursor, pool);
    Parser parser = {.text = cursor->text,
                     .pool = pool,
                     .options = options,
                     .statement = parse_statement,
                     .diag = diag};
    Status status = OK;
    Token first;
    Verb verb;

    statement->pool = pool;
    statement->text = "";
    if (takes_line(lexer, &verb, &first))
        parse_line(&parser, &lexer, &verb, &first, statement);
    else {
        CHECK(parser_start(&parser, &lexer));
        CHECK(lexer_finish(&lexer, diag));
        if (!parser_ends(&parser))
            CHECK(parse_statement(&parser, statement));
        else
            statement->place = parser_token(&parser)->place;
        if (options.whole && statement->row.name != NULL && statement->row.number == VERB_subsystem)
            CHECK(read_body(statement, &lexer, cursor->text, parser.tokens.at[0].start, diag));
    }
    cursor->next = lexer.at;
    cursor->line = lexer.line;
    cursor->line_start = lexer.line_start;
    *out = statement;
    statement = NULL;
done:
    parser_free(&parser);
    statement_free(statement);
    return status;
}

Status statement_parse(const char *text, int line, SyntaxOptions options, size_t *next,
                       Statement **out, Diag *diag)
{
    Cursor cursor = cursor_at(text, line, next != NULL ? *next : 0);
    const Status status = statement_read(&cursor, options, out, diag);

    if (status == OK && next != NULL)
        *next = cursor.next;
    return status;
}

void statement_free(Statement *statement)
{
    Pool *pool = statement != NULL ? statement->pool : NULL;

    if (statement == NULL)
        return;
    for (Statement *s = statement; s != NULL; s = s->rest) {
        LIST_FREE(s->operands);
        LIST_FREE(s->pairs);
    }
    mem_free(statement);
    pool_free(pool);
}
