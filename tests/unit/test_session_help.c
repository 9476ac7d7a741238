/* test_session_help.c: help, examples, reference, completion */
#include "session_kit.h"

#include <ctype.h>

static void every_verb_has_a_page(void)
{
    const char *verb;
    int count = 0;

    for (int i = 0; (verb = ct_verb_name(i)) != NULL; i++, count++) {
        char *page = ct_help(verb);

        EXPECT_HOLDS(page, verb);
        EXPECT_HOLDS(page, "usage: ");
        EXPECT_HOLDS(page, "Example:");
        ct_free(page);
    }
    EXPECT(count > 60);
}

/* files of rows, which the example of `merge` writes; new each time */
static char *append_rows(void *context, const char *name, const char *bytes, size_t length)
{
    FILE *file = fopen(name, "a");

    (void)context;
    if (file == NULL)
        return strdup("no such file");
    (void)fwrite(bytes, 1, length, file);
    fclose(file);
    return NULL;
}

static char *old_rows(void *context, const char *name, char **why)
{
    (void)context, (void)why;
    (void)remove(name);
    return NULL;
}

static void every_example_runs_from_an_empty_session(void)
{
    const ct_hooks hooks = {.columns = 80, .append = append_rows, .content = old_rows};
    const char *name, *text;
    int i;

    for (i = 0; ct_example(i, &name, &text); i++) {
        Kit kit = kit_new();

        ct_session_hooks(kit.session, &hooks);
        if (kit_do(&kit, text) != CT_OK) {
            test_faults++;
            printf("example of '%s': %d:%d: %s (%s)\n", name, kit.error.line, kit.error.column,
                   kit.error.message, kit.error.hint);
        }
        kit_free(&kit);
    }
    EXPECT(i > 40);
    EXPECT(remove("1.rows") == 0 && remove("2.rows") == 0);
}

static void the_overview_names_every_verb_that_is_there(void)
{
    char *overview = ct_help(NULL), *same = ct_help("");
    const char *verb;

    EXPECT_TEXT(same, overview);
    for (int i = 0; (verb = ct_verb_name(i)) != NULL; i++)
        EXPECT_HOLDS(overview, verb);
    ct_free(overview);
    ct_free(same);
}

static void a_page_of_a_component_has_keys_units_and_members(void)
{
    char *page = ct_help("motor");

    EXPECT_HOLDS(page, "usage: motor NAME JOINT PLUS MINUS");
    EXPECT_HOLDS(page, "N*m/A");
    EXPECT_HOLDS(page, "NAME.torque");
    EXPECT_HOLDS(page, "See also:");
    ct_free(page);
}

static void topics_are_pages_too(void)
{
    static const struct {
        const char *word, *part;
    } pages[] = {
        {"units", "rpm"},        {"functions", "atan2("},       {"methods", "dop853"},
        {"simulate", "dop853"},  {"counting", "n-1 additions"}, {"count", "n-1 additions"},
        {"variables", "energy"}, {"topics", "cutsets"},         {"language", "key=value"},
        {"keys", "Ctrl-C"},      {"sin", "function"},           {"jacobian", "show jacobian"}};

    for (size_t i = 0; i < sizeof pages / sizeof pages[0]; i++) {
        char *page = ct_help(pages[i].word);

        EXPECT_HOLDS(page, pages[i].part);
        ct_free(page);
    }
}

static void an_unknown_word_has_no_page_but_a_suggestion(void)
{
    EXPECT(ct_help("revolutt") == NULL);
    EXPECT_TEXT(ct_help_suggest("revolutt"), "revolute");
    EXPECT_TEXT(ct_help_suggest("unit"), "units");
    /* several go on so */
    EXPECT(ct_help("re") == NULL);
    EXPECT(ct_help_suggest("xyzzyxyzzy") == NULL);
}

static void units_and_words_of_variables_have_help(void)
{
    static const char *const wanted[][2] = {{"rpm", "1 rpm is 0.10471975512 rad/s"},
                                            {"mm", "1 mm is 0.001 m"},
                                            {"energy", "energy.kinetic"},
                                            {"energy.kinetic", ".total  of the whole model"},
                                            {"settling", "settling(x, band)"},
                                            {"every", "simulate resume"},
                                            {"within", "expect"},
                                            {"vs", "plot"},
                                            {"mechanism", "draw"},
                                            {"revolut", "usage: revolute"},
                                            {"circ", "show circuits"}};

    for (size_t i = 0; i < sizeof wanted / sizeof wanted[0]; i++) {
        char *text = ct_help(wanted[i][0]);

        EXPECT_HOLDS(text, wanted[i][1]);
        ct_free(text);
    }
}

static void apropos_finds_words_in_the_text(void)
{
    char *lines = ct_apropos("multiplications");
    char *none = ct_apropos("xyzzy");

    EXPECT_HOLDS(lines, "count");
    EXPECT_HOLDS(lines, "help counting");
    EXPECT_TEXT(none, "");
    ct_free(lines);
    ct_free(none);
}

/* --- reference --- */

/* environments of texinfo that a reference uses: each @end closes what was opened last */
static void check_texinfo(const char *text)
{
    static const char *const environments[] = {"table", "example", "display", "menu", "verbatim"};
    int open[16], depth = 0;

    for (const char *line = text; line != NULL && *line != '\0';
         line = strchr(line, '\n') != NULL ? strchr(line, '\n') + 1 : NULL)
        for (int e = 0; e < 5; e++) {
            const size_t length = strlen(environments[e]);

            if (line[0] != '@')
                continue;
            if (strncmp(line + 1, environments[e], length) == 0 &&
                !isalpha((unsigned char)line[1 + length]) && depth < 16)
                open[depth++] = e;
            if (strncmp(line, "@end ", 5) == 0 && strncmp(line + 5, environments[e], length) == 0) {
                EXPECT(depth > 0 && open[depth - 1] == e);
                depth -= depth > 0;
            }
        }
    EXPECT(depth == 0);
}

static void the_reference_holds_every_verb(void)
{
    static const char *const formats[] = {"texinfo", "man", "words"};
    const char *verb;

    for (int f = 0; f < 3; f++) {
        char *text = ct_reference(formats[f]);

        EXPECT(text != NULL && strlen(text) > 500);
        for (int i = 0; (verb = ct_verb_name(i)) != NULL; i++)
            EXPECT_HOLDS(text, verb);
        if (f == 0)
            check_texinfo(text);
        ct_free(text);
    }
    EXPECT(ct_reference("html") == NULL);
}

static void help_keeps_to_the_page(void)
{
    Kit kit = kit_new();
    size_t start = 0;
    char **words = ct_complete(kit.session, "help ", 5, &start);

    for (int i = 0; words[i] != NULL; i++) {
        char *text = ct_help(words[i]);

        for (const char *line = text; line != NULL && *line != '\0';) {
            const size_t length = strcspn(line, "\n");

            /* examples are statements */
            if (length > 80 && strncmp(line, "    ", 4) != 0) {
                test_faults++;
                printf("help %s: %.*s\n", words[i], (int)length, line);
            }
            line += length + (line[length] == '\n');
        }
        ct_free(text);
    }
    ct_words_free(words);
    kit_free(&kit);
}

/* --- completion --- */

static bool offers(Kit *kit, const char *line, const char *word)
{
    size_t start = 0;
    char **words = ct_complete(kit->session, line, strlen(line), &start);
    bool found = false;

    for (int i = 0; words[i] != NULL; i++) {
        found = found || strcmp(words[i], word) == 0;
        /* what is offered goes on from what is written */
        EXPECT(strncmp(words[i], line + start, strlen(line + start)) == 0);
    }
    ct_words_free(words);
    return found;
}

/* what is offered behind a line, and what isn't */
typedef struct Case {
    const char *line, *yes, *no;
} Case;

static void check_cases(const Case *cases, size_t count)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, SLIDER_CRANK "output push = s11*2\nevent hit when=s11 > 1 do=stop\n");
    for (size_t i = 0; i < count; i++) {
        const bool yes =
            strcmp(cases[i].yes, "nothing") == 0 || offers(&kit, cases[i].line, cases[i].yes);

        if (!yes || offers(&kit, cases[i].line, cases[i].no)) {
            test_faults++;
            printf("'%s': %s '%s'\n", cases[i].line, yes ? "offers" : "does not offer",
                   yes ? cases[i].no : cases[i].yes);
        }
    }
    kit_free(&kit);
}

static void completion_follows_the_grammar(void)
{
    /* clang-format off */
    static const Case cases[] = {
        {"rev",                    "revolute",    "plot"},
        {"",                       "body",        "m1"},
        {"virtual ",               "prismatic",   "body"},
        {"revolute h12 ",          "r4",          "h8"},
        {"revolute h12 r4 g",      "ground",      "gravity"},
        {"revolute h12 r4 r5 ",    "axis=",       "r4"},
        {"revolute h12 r4 r5 axis=", "x",         "h8"},
        {"revolute h12 r4 r5 axis=x ", "coord=",  "axis="},
        {"motor M1 ",              "h8",          "r4"},
        {"motor M1 h8 ",           "0",           "h8"},
        {"show con",               "constraints", "h8"},
        {"show ",                  "derivation",  "velocity"},
        {"show derivation ",       "h9",          "mass"},
        {"show derivation ma",     "mass(",       "forces("},
        {"show tr",                "transfer",    "h8"},
        {"bode h8 ",               "points=",     "every="},
        {"show h",                 "h8",          "mass"},
        {"show cutsets ",          "h9",          "constraints"},
        {"show mass as ",          "latex",       "h8"},
        {"show h8.",               "h8.fx",       "h8.v"},
        {"count ",                 "mass",        "m1"},
        {"tree rotation ",         "h9",          "L4"},
        {"tree h8 h",              "h10",         "help"},
        {"simulate 2 ",            "every=",      "h8"},
        {"simulate 2 method=",     "dop853",      "h8"},
        {"simulate 2 every=0.1 r", "rtol=",       "revolute"},
        {"plot h8 s",              "s11",         "show"},
        {"plot energy.",           "energy.total", "h8"},
        {"print ab",               "abs(",        "arm"},
        {"print model.",           "model.dof",   "h8"},
        {"print count.",           "count.mass",  "h8"},
        {"init h",                 "h8",          "help"},
        {"init h8 = 1, h",         "h10",         "help"},
        {"set m1.",                "m1.mass",     "m1.x"},
        {"set m1.euler=",          "parameters",  "tree"},
        {"set n",                  "network",     "now"},
        {"set network ",           "tree",        "m1"},
        {"set network = ",         "state",       "m1"},
        {"set m1 ",                "m1",          "tree"},
        {"delete m",               "m1",          "model"},
        {"delete L",               "L4",          "L9"},
        {"delete ",                "hit",         "ground"},
        {"delete p",               "push",        "pi"},
        {"info h",                 "hit",         "help"},
        {"event h",                "hit",         "h8"},
        {"event hit ",             "when=",       "hit"},
        {"show h",                 "hit",         "help"},
        {"show mass ",             "nothing",     "h8"},
        {"show constraints ",      "velocity",    "h8"},
        {"show constraints v",     "velocity",    "vx"},
        {"print h",                "h8",          "hit"},
        {"plot l",                 "last",        "list"},
        {"help rev",               "revolute",    "r4"},
        {"?uni",                   "units",       "h8"},
        {"body b mass=2 k",        "kg",          "k1"},
        {"x = L",                  "L4",          "log("},
        {"print 1; sho",           "show",        "s11"},
        {"time sim",               "simulate",    "s11"},
        {"print h8 # rev",         "nothing",     "revolute"},
        {"title \"rev",            "nothing",     "revolute"},
    };
    /* clang-format on */

    check_cases(cases, sizeof cases / sizeof cases[0]);
}

static void completion_tells_units_from_words(void)
{
    /* clang-format off */
    static const Case cases[] = {
        /* units: of the dimension that is wanted there */
        {"body b mass=2k",         "kg",          "km"},
        {"set m1.mass = 3 ",       "m1",          "kg"},
        {"set m1.mass = 3 k",      "kg",          "kN"},
        {"init h8 = 30 d",         "deg",         "day"},
        {"init h8' = 30 r",        "rpm",         "rev"},
        {"L4 = 10 m",              "mm",          "m1"},
        {"print h8 [",             "deg",         "mm"},
        {"print m1.x + 2*s11 [",   "mm",          "deg"},
        {"print m1.x, h8' [",      "rad/s",       "mm"},
        {"plot m1.x (h8 - 1) [d",  "deg",         "day"},
        {"plot h8 xrange=[0, 1] [", "ms",         "h8"},
        {"spring k1 h8 k=1 [",     "N*m",         "kg"},
        {"spring k1 h8 k=1 [kN/",  "mm",          "kg/m"},
        {"arm r9 m1 [L",           "L4",          "L"},
        {"arm r9 m1 [0, L",        "L4",          "L"},
        {"resistor R1 a b 10k",    "kohm",        "kg"},
        /* words that go on behind operands, and not before they are whole */
        {"expect h8 ",             "~",           "within"},
        {"expect h8 ~ ",           "h8",          "within"},
        {"expect h8 ~ 3 ",         "within",      "h8"},
        {"expect h8 ~ 3 + ",       "h8",          "within"},
        {"expect h8 ~ 3 within 1 ", "at",         "within"},
        {"expect h8 < ",           "h8",          "at"},
        {"plot h8 v",              "vs",          "vsource"},
        {"plot h8 vs s",           "s11",         "vs"},
        {"plot h8 [deg] ",         "title=",      "last"},
        {"plot h8 | ",             "s11",         "vs"},
        {"print h8 a",             "at",          "abs("},
        {"print h8, a",            "abs(",        "at"},
        {"keep A = h8 ",           "at",          "within"},
        {"show mass a",            "as",          "at"},
        {"show power a",           "at",          "abs("},
        {"init h8 = 2*L",          "L4",          "log"},
        /* help of all that has a name */
        {"help h",                 "h8",          "h"},
        {"help rp",                "rpm",         "h8"},
        {"help ener",              "energy",      "rpm"},
        {"help at",                "atan2",       "h8"},
    };
    /* clang-format on */

    check_cases(cases, sizeof cases / sizeof cases[0]);
}

static void completion_knows_what_was_linearized(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, "vsource E1 a 0 1\nresistor R1 a b 2\ncapacitor C1 b 0 3\n"
                      "output store = C1.v*2\noutput heat = R1.power\n");
    /* before, anything may become an output */
    EXPECT(offers(&kit, "bode ", "heat"));
    EXPECT_DONE(&kit, "linearize inputs=[E1] outputs=[store, R1.i]\n");
    EXPECT(offers(&kit, "bode ", "store"));
    EXPECT(offers(&kit, "bode ", "R1.i"));
    EXPECT(!offers(&kit, "bode ", "heat"));
    EXPECT(offers(&kit, "bode store ", "R1.i"));
    EXPECT(offers(&kit, "bode store ", "from="));
    EXPECT(offers(&kit, "show transfer ", "store"));
    EXPECT(!offers(&kit, "show transfer ", "E1"));
    EXPECT(offers(&kit, "show transfer store ", "E1"));
    EXPECT(!offers(&kit, "show transfer store ", "R1.i"));
    EXPECT(!offers(&kit, "show transfer store E1 ", "E1"));
    kit_free(&kit);
}

/* variables of a run that is there, and its parts, whatever expression they stand in */
static void completion_goes_on_behind_a_run(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, SLIDER_CRANK "init h8 = 1\nsimulate 0.1\n");
    EXPECT(offers(&kit, "plot run1.", "s11"));
    EXPECT(offers(&kit, "plot run1.h", "h8"));
    EXPECT(!offers(&kit, "plot run1.r", "run1"));
    EXPECT(offers(&kit, "plot run1.h8 (run1.s11 - run1.m1.v", "m1.vx"));
    EXPECT(offers(&kit, "print run1.en", "energy"));
    EXPECT(!offers(&kit, "plot run2.", "h8"));
    kit_free(&kit);
}

/* what init takes: also what parts of circuits store, and nothing that follows from the rest */
static void completion_offers_what_can_be_given(void)
{
    size_t start = 0;
    Kit kit = kit_new();
    char **words;
    int count = 0;

    EXPECT_DONE(&kit, SLIDER_CRANK "vsource E1 a 0 1\nresistor R1 a b 2\ncapacitor C1 b 0 3\n"
                                   "motor M7 h8 a 0 R=1 L=0.1 Kt=0.5 Kv=0.5\n");
    EXPECT(offers(&kit, "init C", "C1.v"));
    EXPECT(offers(&kit, "guess M", "M7.i"));
    EXPECT(!offers(&kit, "init ", "R1.power"));
    words = ct_complete(kit.session, "init ", 5, &start);
    for (; words[count] != NULL; count++) {
        char line[80];
        (void)snprintf(line, sizeof line, "init %s = 0.1\n", words[count]);
        if (strcmp(words[count], "none") != 0)
            EXPECT_DONE(&kit, line);
    }
    EXPECT(count > 10);
    ct_words_free(words);
    kit_free(&kit);
}

/* whatever unit is offered behind a number is read there */
static void every_unit_that_is_offered_is_read(void)
{
    static const char *const lines[] = {"x = 1 [",   "x = 1 k",          "x = 1 m",    "x = 1u",
                                        "x = 1 [N*", "body k1 mass=1 [", "print h8' ["};
    Kit kit = kit_new();

    EXPECT_DONE(&kit, SLIDER_CRANK);
    for (size_t i = 0; i < sizeof lines / sizeof lines[0]; i++) {
        size_t start = 0;
        char **words = ct_complete(kit.session, lines[i], strlen(lines[i]), &start);
        int count = 0;

        for (; words[count] != NULL; count++) {
            char line[120];

            (void)snprintf(line, sizeof line, "%.*s%s%s\n", (int)start, lines[i], words[count],
                           strchr(lines[i], '[') != NULL ? "]" : "");
            EXPECT_DONE(&kit, line);
            if (strncmp(line, "print", 5) != 0)
                EXPECT_DONE(&kit, line[0] == 'x' ? "delete x\n" : "delete k1\n");
        }
        EXPECT(count > 0);
        ct_words_free(words);
    }
    kit_free(&kit);
}

static const char *const *program_setting(void *context, int i)
{
    static const char *const colour[] = {"colour", "red", "blue", NULL};

    return i == 0 ? colour : context;
}

static void completion_offers_runs_that_are_there(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, SLIDER_CRANK "init h8 = 1\n");
    EXPECT(!offers(&kit, "animate ", "run1"));
    EXPECT_DONE(&kit, "simulate 0.1\nsimulate 0.1\n");
    EXPECT(offers(&kit, "animate ", "run1"));
    EXPECT(offers(&kit, "animate ", "run2"));
    EXPECT(offers(&kit, "animate ", "from="));
    EXPECT(!offers(&kit, "animate ", "run3"));
    EXPECT(!offers(&kit, "animate ", "h8"));
    EXPECT(!offers(&kit, "animate run1 ", "run2"));
    EXPECT(offers(&kit, "animate run1 ", "speed="));
    EXPECT(offers(&kit, "print ru", "run2"));
    kit_free(&kit);
}

/* what draw would refuse isn't offered */
static void completion_tells_the_graph_from_the_mechanism(void)
{
    static const char *const graph[] = {"draw ", "draw cutset ", "draw cutset h8 ",
                                        "draw circuit h9 "};
    static const char *const options[] = {"at", "view=", "reactions="};
    Kit kit = kit_new();

    EXPECT_DONE(&kit, SLIDER_CRANK);
    for (size_t o = 0; o < sizeof options / sizeof options[0]; o++) {
        for (size_t i = 0; i < sizeof graph / sizeof graph[0]; i++)
            EXPECT(!offers(&kit, graph[i], options[o]));
        EXPECT(offers(&kit, "draw mechanism ", options[o]));
    }
    EXPECT(offers(&kit, "draw cutset ", "h8"));
    EXPECT(!offers(&kit, "draw mechanism ", "h8"));
    kit_free(&kit);
}

static void completion_knows_the_settings_of_the_program(void)
{
    const ct_hooks hooks = {.setting = program_setting};
    Kit kit = {.session = ct_session_new(&hooks)};

    EXPECT(offers(&kit, "set co", "colour"));
    EXPECT(offers(&kit, "set ", "network"));
    EXPECT(offers(&kit, "set colour ", "red"));
    EXPECT(offers(&kit, "set colour b", "blue"));
    EXPECT(offers(&kit, "set colour=", "blue"));
    EXPECT(!offers(&kit, "set network ", "red"));
    kit_free(&kit);
}

static void completion_says_where_the_word_starts(void)
{
    Kit kit = kit_new();
    size_t start = 0;
    char **words = ct_complete(kit.session, "print 1;  sho", 13, &start);

    EXPECT(start == 10);
    EXPECT_TEXT(words[0], "show");
    ct_words_free(words);
    /* the cursor may stand inside the line, or beyond it */
    words = ct_complete(kit.session, "sho mass", 3, &start);
    EXPECT_TEXT(words[0], "show");
    ct_words_free(words);
    words = ct_complete(kit.session, "sho", 300, &start);
    EXPECT(start == 0);
    ct_words_free(words);
    kit_free(&kit);
}

/* whatever the line: no crash, and offers that fit */
static void completion_bears_any_line(void)
{
    static const char *const pieces[] = {
        "tree ", "show ", "h8",       ".",   "'",   "=",        "\"",    ";", "(", " ",    "5", "+",
        ",",     "[",     "motor M ", "as ", "at ", "virtual ", "init ", "#", "?", "set ", ":"};
    Kit kit = kit_new();
    uint64_t state = 7;
    char line[200];

    EXPECT_DONE(&kit, SLIDER_CRANK);
    for (int i = 0; i < 5000; i++) {
        size_t length = 0;

        line[0] = '\0';
        for (int k = (int)(test_random(&state) % 8); k >= 0; k--)
            length +=
                (size_t)snprintf(line + length, sizeof line - length, "%s",
                                 pieces[test_random(&state) % (sizeof pieces / sizeof pieces[0])]);
        (void)offers(&kit, line, "nothing");
    }
    kit_free(&kit);
}

/* every word of every example is what completion would have offered there, or a name, a number or
 * an expression of the user's own: at least the verbs and keys must be */
static void completion_offers_the_verbs_and_keys_of_every_example(void)
{
    const char *name, *text;

    for (int i = 0; ct_example(i, &name, &text); i++) {
        Kit kit = kit_new();

        while (*text != '\0') {
            const size_t length = strcspn(text, "\n");
            char line[400];
            ct_statement *statement = NULL;

            (void)snprintf(line, sizeof line, "%.*s", (int)length, text);
            if (ct_parse(&(ct_cursor){.text = line, .line = 1}, false, &statement, &kit.error) ==
                CT_OK) {
                const char *verb = ct_verb(statement);
                char half[80];

                if (verb[0] != '\0' && line[0] != '?' && strncmp(line, "virtual", 7) != 0) {
                    (void)snprintf(half, sizeof half, "%.2s", verb);
                    EXPECT(offers(&kit, half, verb));
                }
            }
            ct_statement_free(statement);
            text += length + (text[length] == '\n');
        }
        kit_free(&kit);
    }
}

static void help_alone_tells_of_the_tour(void)
{
    char *text = ct_help(NULL);

    EXPECT_HOLDS(text, "tour");
    EXPECT_HOLDS(text, "info cotree");
    ct_free(text);
}

int main(void)
{
    RUN(help_alone_tells_of_the_tour);
    RUN(every_verb_has_a_page);
    RUN(every_example_runs_from_an_empty_session);
    RUN(the_overview_names_every_verb_that_is_there);
    RUN(a_page_of_a_component_has_keys_units_and_members);
    RUN(topics_are_pages_too);
    RUN(an_unknown_word_has_no_page_but_a_suggestion);
    RUN(units_and_words_of_variables_have_help);
    RUN(apropos_finds_words_in_the_text);
    RUN(the_reference_holds_every_verb);
    RUN(help_keeps_to_the_page);
    RUN(completion_follows_the_grammar);
    RUN(completion_tells_units_from_words);
    RUN(completion_knows_what_was_linearized);
    RUN(completion_offers_runs_that_are_there);
    RUN(completion_tells_the_graph_from_the_mechanism);
    RUN(completion_goes_on_behind_a_run);
    RUN(completion_offers_what_can_be_given);
    RUN(every_unit_that_is_offered_is_read);
    RUN(completion_knows_the_settings_of_the_program);
    RUN(completion_says_where_the_word_starts);
    RUN(completion_bears_any_line);
    RUN(completion_offers_the_verbs_and_keys_of_every_example);
    return test_end();
}
