/* family_machine_uses.c: machines that are used twice as subsystems, changed between runs and
 * saved, against equations of another kind
 *
 * Random machines with switches, diodes, sampled control and events have a few numbers that are
 * parameters. As a subsystem two of them stand beside each other with other numbers; alone one
 * runs, gets other numbers and runs again, and so does what `save` writes of it. Each is held
 * against the oracle of machine_hybrid.h. */
#include "machine_hybrid_draw.h"
#include "machine_inputs.h"

enum { CHANGES = 2 };

typedef struct Change {
    size_t place; /* in a Hybrid, of the number */
    double was, becomes;
    char name[16];
} Change;

typedef struct Changes {
    int count;
    Change change[CHANGES];
} Changes;

/* numbers that move no frame become parameters */
static void draw_changes(Member *member, Hybrid *h, Changes *c)
{
    static CompiledEquations numbers;
    Machine *m = &h->d.m;

    c->count = 0;
    find_numbers(m, &numbers);
    for (int tries = 0; tries < 40 && c->count < CHANGES; tries++) {
        double *number = numbers.at[member_one_of(member, numbers.count)];
        Change *one = &c->change[c->count];
        const char *byte = (const char *)number;

        if (*number == 0 || (c->count > 0 && *number == c->change[0].was) ||
            (byte >= (const char *)m->place && byte < (const char *)(m->place + PLACES)) ||
            (byte >= (const char *)m->hinge && byte < (const char *)(m->hinge + HINGES)))
            continue;
        *one = (Change){.place = (size_t)(byte - (const char *)h), .was = *number};
        (void)snprintf(one->name, sizeof one->name, "P%d", c->count);
        one->becomes = *number * member_between(member, 0.7, 1.4);
        if (make_parameter(&h->d.script, *number, one->name))
            c->count++;
    }
}

static void change(Hybrid *h, const Changes *c)
{
    for (int i = 0; i < c->count; i++)
        memcpy((char *)h + c->change[i].place, &c->change[i].becomes, sizeof(double));
}

/* what is told of a run against the oracle; `prefix` stands before each name */
static Verdict told_alike(Member *member, Kit *kit, Hybrid *h, const char *prefix)
{
    static Instant now;
    static Asks asks;
    Real y[MOST_STATES];
    double at = 0;

    memcpy(y, h->d.y, sizeof y);
    if (!hybrid_starts(h, y))
        return REFUSED;
    for (int part = 0; part < 2; part++) {
        if (!hybrid_runs(h, &at, 0.0731 + 0.2 * part, y) || h->unsure)
            return REFUSED;
        if (at - h->last < 1e-6)
            continue;
        unpack(&h->d.m, y, &now);
        if (!instant_solve(&h->d.m, &now))
            return REFUSED;
        ask_all(&h->d.m, &now, &asks);
        for (int i = 0; i < asks.count; i++) {
            char text[sizeof asks.ask[i].text];

            (void)snprintf(text, sizeof text, "%s%.40s", prefix, asks.ask[i].text);
            memcpy(asks.ask[i].text, text, sizeof text);
        }
        if (compare(member, kit, &asks, at, 3e-6) == DISAGREES)
            return DISAGREES;
    }
    return AGREES;
}

static void write_run(Member *member, Script *script)
{
    write_line(script, "simulate 0.3 every=0.1 rtol=1e-9 atol=1e-11 method=%s",
               draw_method(member));
}

/* the worse of two */
static Verdict both(Verdict a, Verdict b)
{
    return a == DISAGREES || b == DISAGREES ? DISAGREES : a == REFUSED ? a : b;
}

/* as a definition that is used twice, the second time with other numbers */
static void write_uses(const Script *from, const Changes *c, Script *to)
{
    const char *line = from->text;
    bool inside = false;

    to->length = 0;
    for (int pass = 0; pass < 2; pass++)
        for (line = from->text; *line != '\0'; line += strcspn(line, "\n") + 1) {
            const bool outside = strncmp(line, "scene", 5) == 0 || strncmp(line, "gravity", 7) == 0;

            if (outside != (pass == 0))
                continue;
            if (pass == 1 && !inside)
                write_line(to, "subsystem part");
            inside = pass == 1;
            write_line(to, "%.*s", (int)strcspn(line, "\n"), line);
        }
    write_line(to, "end");
    write_piece(to, "use part u1 u2");
    for (int i = 0; i < c->count; i++)
        write_piece(to, " %s=[%.17g, %.17g]", c->change[i].name, c->change[i].was,
                    c->change[i].becomes);
    write_line(to, "%s", "");
}

/* Two of a subsystem move as each of them does. */
static Verdict uses_move(Member *member)
{
    static Hybrid h, other;
    static Changes c;
    static Script script;
    Kit kit = kit_new();
    Verdict verdict = REFUSED;

    while (!draw_hybrid(member, &h, false))
        ;
    draw_changes(member, &h, &c);
    write_uses(&h.d.script, &c, &script);
    if (chance(member, 0.6))
        write_line(&script, "tree %s", chance(member, 0.5) ? "joint" : "absolute");
    write_run(member, &script);
    other = h;
    change(&other, &c);
    if (do_told(member, &kit, script.text) == CT_OK) {
        verdict = told_alike(member, &kit, &h, "u1.");
        verdict = both(verdict, told_alike(member, &kit, &other, "u2."));
    }
    kit_free(&kit);
    return verdict;
}

/* With other numbers a model runs as they say, and so does what is saved of it. */
static Verdict changed_move(Member *member)
{
    static Hybrid h, other;
    static Changes c;
    static Script script;
    Kit kit = kit_new(), saved = kit_new();
    Verdict verdict = REFUSED;
    char *text = NULL;

    while (!draw_hybrid(member, &h, false))
        ;
    draw_changes(member, &h, &c);
    draw_tree(member, &h.d, member_one_of(member, 3));
    write_run(member, &h.d.script);
    script.length = 0;
    for (int i = 0; i < c.count; i++)
        write_line(&script, "%s = %.17g", c.change[i].name, c.change[i].becomes);
    write_run(member, &script);
    other = h;
    change(&other, &c);
    if (do_told(member, &kit, h.d.script.text) == CT_OK) {
        verdict = told_alike(member, &kit, &h, "");
        if (verdict == AGREES && do_told(member, &kit, script.text) == CT_OK) {
            h = other;
            verdict = told_alike(member, &kit, &h, "");
            text = ct_save(kit.session);
        }
    }
    if (verdict == AGREES && text != NULL) {
        if (do_told(member, &saved, text) != CT_OK ||
            do_told(member, &saved, "simulate 0.3 every=0.1 rtol=1e-9 atol=1e-11\n") != CT_OK)
            verdict = DISAGREES;
        else
            verdict = told_alike(member, &saved, &other, "");
    }
    ct_free(text);
    kit_free(&kit);
    kit_free(&saved);
    return verdict;
}

static const Family families[] = {
    {"two machines of a subsystem move as each does", 3, 0.5, 0, uses_move},
    {"machines with other numbers move as those say", 3, 0.5, 0, changed_move},
};

int main(int argc, char **argv)
{
    return family_main(families, (int)(sizeof families / sizeof families[0]), argc, argv);
}
