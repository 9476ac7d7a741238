/* family_edits.c: a model that was edited between its equations is the model made so at once
 *
 * One session shows and runs equations after each edit, another takes the same statements and is
 * asked at the end alone: what both print is the same, byte for byte, and so is what they run. A
 * joint that is made anew comes last among the coordinates, and stands among the terms of sums
 * where its name was first met: then the numbers are the same but for rounding.
 *
 * Large models hold numbers of parts as parameters of the equations: they move as those do whose
 * numbers are the user's parameters.
 *
 * A parameter may have the name of a part: then the model moves, costs and is saved as with names
 * of their own, in either order of the two.
 *
 * Instances come and go beside others that stay, of which nothing is derived again: then, too, each
 * model moves as the one made of the same statements in a session that is asked for the first time.
 */
#include "edits.h"

#include "../unit/session_kit.h"

#include <ctype.h>

/* what a user sees of it */
typedef struct Seen {
    Text text;
    double values[MOST_BODIES];
} Seen;

static void look(const Draft *draft, Kit *kit, Seen *seen)
{
    /* of many bodies M and F are too long to be read */
    static const char *const asked[] = {"show coordinates", "simulate 0.01", "show mass",
                                        "show forces", "count"};

    text_free(&seen->text);
    for (int i = 0; i < (draft->bodies > 4 ? 2 : COUNT(asked)); i++) {
        const ct_status status = kit_do(kit, asked[i]);

        /* a report tells seconds */
        if (status != CT_OK || (kit->text != NULL && strncmp(asked[i], "simulate", 8) != 0))
            text_add(&seen->text, status != CT_OK ? kit->error.message : kit->text);
    }
    for (int i = 0; i < draft->bodies; i++) {
        char what[40];

        (void)snprintf(what, sizeof what, "b%d.x + b%d.vy", i, i);
        seen->values[i] = kit_value(kit, what);
        text_addf(&seen->text, "%s: %a\n", what, seen->values[i]);
    }
}

static bool are_alike(const Draft *draft, const Seen *one, const Seen *other)
{
    if (!draft->is_reordered)
        return strcmp(one->text.at, other->text.at) == 0;
    for (int i = 0; i < draft->bodies; i++) {
        const double a = one->values[i], b = other->values[i];

        if (isnan(a) != isnan(b) || fabs(a - b) > 1e-8 * (1 + fabs(a)))
            return false;
    }
    return true;
}

static Verdict edits_leave_no_trace(Member *member)
{
    Draft draft = {.member = member};
    Text lines = {0};
    Seen one = {0}, other = {0};
    Kit edited = kit_new(), fresh = kit_new();
    Verdict verdict = AGREES;

    add_model(&draft, &lines);
    for (int k = 0; k <= EDITS && verdict == AGREES; k++) {
        tell(member, "%s", lines.at);
        if (kit_do(&edited, lines.at) != CT_OK) {
            /* a joint whose tail is elsewhere: both are left as they were */
            (void)kit_do(&fresh, lines.at);
            tell(member, "  (%s)\n", edited.error.message);
        } else if (kit_do(&fresh, lines.at) != CT_OK) {
            verdict = DISAGREES;
        }
        look(&draft, &edited, &one);
        text_free(&lines);
        add_edit(&draft, &lines);
    }
    look(&draft, &fresh, &other);
    if (verdict == AGREES && !are_alike(&draft, &one, &other)) {
        tell(member, "edited:\n%.5000s\nfresh:\n%.5000s\n", one.text.at, other.text.at);
        verdict = DISAGREES;
    }
    text_free(&lines);
    text_free(&one.text);
    text_free(&other.text);
    kit_free(&edited);
    kit_free(&fresh);
    return verdict;
}

/* where no number of parts is a parameter of its own: it is one of the user's */
static Verdict literals_are_parameters(Member *member)
{
    const uint64_t begun = member->random;
    double seen[2][MOST_BODIES][2] = {{{0}}};
    int bodies = 0;

    for (int named = 0; named < 2; named++) {
        Draft draft = {.member = member, .is_named = named == 1, .is_large = true};
        Text lines = {0};
        Kit kit = kit_new();

        member->random = begun;
        add_model(&draft, &lines);
        if (draft.is_named)
            text_add(&draft.parameters, lines.at);
        bodies = draft.bodies;
        tell(member, "%s", named == 0 ? lines.at : "");
        if (kit_do(&kit, draft.is_named ? draft.parameters.at : lines.at) != CT_OK ||
            kit_do(&kit, "simulate 0.02\n") != CT_OK)
            tell(member, "%s: %s\n", named == 0 ? "numbers" : "parameters", kit.error.message);
        for (int i = 0; i < bodies; i++) {
            char what[40];

            (void)snprintf(what, sizeof what, "b%d.x", i);
            seen[named][i][0] = kit_value(&kit, what);
            (void)snprintf(what, sizeof what, "b%d.vy", i);
            seen[named][i][1] = kit_value(&kit, what);
        }
        kit_free(&kit);
        text_free(&lines);
        text_free(&draft.parameters);
    }
    for (int i = 0; i < 2 * bodies; i++) {
        const double a = seen[0][i / 2][i % 2], b = seen[1][i / 2][i % 2];

        if (isnan(a) != isnan(b) || fabs(a - b) > 1e-7 * (1 + fabs(a))) {
            tell(member, "b%d: %.17g with numbers, %.17g with parameters\n", i / 2, a, b);
            return DISAGREES;
        }
    }
    return isnan(seen[0][0][0]) ? REFUSED : AGREES;
}

/* --- parameters with the names of parts --- */

enum { MOST_NAMED = 512 };

/* what the parameters are called: p1, p2 ... or, of some of them, as parts are */
typedef struct Called {
    char name[MOST_NAMED][16];
    bool at_use; /* a parameter stands before its first use, not before all parts */
    bool is_made[MOST_NAMED];
} Called;

static void call_as_parts(Draft *draft, Called *called)
{
    static const char kinds[] = {'b', 'h', 't', 's'};
    int free[MOST_NAMED];
    const int count = draft->named < MOST_NAMED - 1 ? draft->named : MOST_NAMED - 1;

    for (int k = 1; k <= count; k++)
        free[k - 1] = k;
    for (int n = 0; n < COUNT(kinds) * draft->bodies && n < count; n++) {
        const int other = n + below(draft, count - n), k = free[other];

        free[other] = free[n];
        (void)snprintf(called->name[k], sizeof called->name[k], "%c%d", kinds[n % COUNT(kinds)],
                       n / COUNT(kinds));
    }
}

/* the text, up to its end or `end`, with the parameters called so */
static void write_called(const char *text, size_t length, const Called *called, Text *out)
{
    for (size_t i = 0; i < length; i++) {
        const int k =
            text[i] == 'p' && isdigit((unsigned char)text[i + 1]) ? atoi(text + i + 1) : 0;

        if (k == 0 || (i > 0 && isalnum((unsigned char)text[i - 1]))) {
            text_char(out, text[i]);
            continue;
        }
        text_add(out, called->name[k]);
        i += strspn(text + i + 1, "0123456789");
    }
}

/* the lines that make the parameters of one line which are not yet there */
static void write_parameters(const Draft *draft, const char *line, size_t length, Called *called,
                             Text *out)
{
    for (size_t i = 0; i < length; i++) {
        const int k =
            line[i] == 'p' && isdigit((unsigned char)line[i + 1]) ? atoi(line + i + 1) : 0;
        const char *made = draft->parameters.at;

        if (k == 0 || (i > 0 && isalnum((unsigned char)line[i - 1])) || called->is_made[k])
            continue;
        called->is_made[k] = true;
        for (int skip = 1; skip < k; skip++)
            made = strchr(made, '\n') + 1;
        write_called(made, strcspn(made, "\n") + 1, called, out);
    }
}

static void write_model(const Draft *draft, const char *lines, Called *called, Text *out)
{
    if (!called->at_use)
        write_called(draft->parameters.at, draft->parameters.length, called, out);
    for (const char *line = lines; *line != '\0';) {
        const size_t length = strcspn(line, "\n") + 1;

        if (called->at_use)
            write_parameters(draft, line, length, called, out);
        write_called(line, length, called, out);
        line += length;
    }
}

/* counts, where they aren't too long, then x and vy of each body after a run; whether there was one
 */
static bool see(const Draft *draft, const char *text, Kit *kit, Text *counts, double *values)
{
    const bool ran = kit_do(kit, text) == CT_OK && kit_do(kit, "simulate 0.02\n") == CT_OK;

    if (!ran)
        tell(draft->member, "%s\n", kit->error.message);
    text_add(counts, "counts\n");
    if (draft->bodies <= 4 && kit_do(kit, "count") == CT_OK)
        text_add(counts, kit->text);
    for (int i = 0; i < 2 * draft->bodies; i++) {
        char what[40];

        (void)snprintf(what, sizeof what, i % 2 == 0 ? "b%d.x" : "b%d.vy", i / 2);
        values[i] = kit_value(kit, what);
    }
    return ran;
}

static Verdict shared_names_change_nothing(Member *member)
{
    enum { OWN, SHARED, READ_BACK, CASES };
    Draft draft = {.member = member, .is_named = true};
    static Called own, shared;
    Text lines = {0}, texts[CASES] = {{0}}, counts[CASES] = {{0}};
    double values[CASES][2 * MOST_BODIES];
    Verdict verdict = AGREES;
    bool ran[CASES];

    add_model(&draft, &lines);
    text_add(&lines, draft.planar ? "arm far ground [3, 2]\n" : "arm far ground [3, 2, 1]\n");
    for (int i = 0; i < draft.bodies; i++) {
        text_addf(&lines, "spring s%d far h%d k=", i, i);
        add_number(&draft, &lines, 1, 9);
        text_add(&lines, " length=");
        add_number(&draft, &lines, 0.1, 0.4);
        text_char(&lines, '\n');
    }
    own = (Called){.at_use = member_one_of(member, 2) == 0};
    for (int k = 1; k < MOST_NAMED; k++)
        (void)snprintf(own.name[k], sizeof own.name[k], "p%d", k);
    shared = own;
    call_as_parts(&draft, &shared);
    write_model(&draft, lines.at, &own, &texts[OWN]);
    write_model(&draft, lines.at, &shared, &texts[SHARED]);
    tell(member, "%s", texts[SHARED].at);
    for (int c = OWN; c < CASES; c++) {
        Kit kit = kit_new();

        ran[c] = see(&draft, texts[c].at, &kit, &counts[c], values[c]);
        if (c == SHARED) {
            char *saved = ct_save(kit.session);

            text_add(&texts[READ_BACK], saved);
            ct_free(saved);
        }
        kit_free(&kit);
    }
    for (int c = SHARED; c < CASES; c++)
        if (ran[c] != ran[OWN] || strcmp(counts[c].at, counts[OWN].at) != 0) {
            tell(member, "case %d:\n%s%s", c, counts[c].at, counts[OWN].at);
            verdict = DISAGREES;
        }
    for (int i = 0; i < 2 * draft.bodies; i++) {
        const double a = values[OWN][i], b = values[SHARED][i];

        /* sums take their terms in an order of names */
        if (isnan(a) != isnan(b) || fabs(a - b) > 1e-9 * (1 + fabs(a)) ||
            !(values[READ_BACK][i] == b || (isnan(values[READ_BACK][i]) && isnan(b)))) {
            tell(member, "value %d: %a with names of their own, %a shared, %a read back\n", i, a, b,
                 values[READ_BACK][i]);
            verdict = DISAGREES;
        }
    }
    text_free(&lines);
    text_free(&draft.parameters);
    for (int c = OWN; c < CASES; c++) {
        text_free(&texts[c]);
        text_free(&counts[c]);
    }
    return verdict == AGREES && !ran[OWN] ? REFUSED : verdict;
}

/* where parts stand and what moves them, as far as there are such parts: */
static const struct Asked {
    const char *of, *what;
} asked_of_slots[] = {{"leg", ".l1.x"},        {"leg", ".l2.vy"}, {"leg", ".l2.ax"},
                      {"leg", ".k'"},          {"leg", ".h.fx"},  {"leg", ".left.l2.ay"},
                      {"leg", ".right.l1.ax"}, {"h", ".fy"},      {"f", ".ay"}};
enum { ASKED = COUNT(asked_of_slots), VALUES = 1 + ASKED * SLOTS };

static void look_at_robot(const Robot *robot, Kit *kit, double *values)
{
    if (kit_do(kit, "simulate 0.005\n") != CT_OK)
        tell(robot->member, "  (%s)\n", kit->error.message);
    values[0] = kit_value(kit, "m.ax");
    for (int i = 0; i < robot->slots; i++)
        for (int k = 0; k < ASKED; k++) {
            char name[40];

            (void)snprintf(name, sizeof name, "%s%d%s", asked_of_slots[k].of, i,
                           asked_of_slots[k].what);
            values[1 + i * ASKED + k] = kit_value(kit, name);
        }
}

static Verdict instances_leave_no_trace(Member *member)
{
    Robot robot = {.member = member};
    Text lines = {0};
    Kit edited = kit_new(), fresh = kit_new();
    double seen[2][VALUES];
    Verdict verdict = AGREES;
    int known = 0;

    for (int i = 0; i < 2 * VALUES; i++)
        seen[i / VALUES][i % VALUES] = NAN;
    add_robot(&robot, &lines);
    for (int k = 0; k <= CHANGES; k++) {
        tell(member, "%s", lines.at);
        if (kit_do(&edited, lines.at) != CT_OK)
            tell(member, "  (%s)\n", edited.error.message);
        (void)kit_do(&fresh, lines.at);
        look_at_robot(&robot, &edited, seen[0]);
        text_free(&lines);
        add_change(&robot, &lines);
    }
    look_at_robot(&robot, &fresh, seen[1]);
    for (int i = 0; i < VALUES; i++) {
        const double a = seen[0][i], b = seen[1][i];

        known += !isnan(b);
        if (isnan(a) != isnan(b) || fabs(a - b) > 1e-6 * (1 + fabs(a))) {
            tell(member, "value %d: %.17g edited, %.17g fresh\n", i, a, b);
            verdict = DISAGREES;
        }
    }
    text_free(&lines);
    kit_free(&edited);
    kit_free(&fresh);
    return verdict == AGREES && known == 0 ? REFUSED : verdict;
}

static const Family families[] = {
    {"numbers of a large model move it as parameters of the user's do", 4, 0.2, 0,
     literals_are_parameters},
    {"a model edited between its equations is the one made so at once", 30, 0, 0,
     edits_leave_no_trace},
    {"a parameter with the name of a part is one with a name of its own", 4, 0.2, 0,
     shared_names_change_nothing},
    {"instances come and go as in a model made so at once", 5, 0.3, 0, instances_leave_no_trace},
};

int main(int argc, char **argv)
{
    return family_main(families, COUNT(families), argc, argv);
}
