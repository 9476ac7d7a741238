/* family_cells.c: networks of many cells, nested too, each an instance of a definition, against the
 * same parts written out one by one
 *
 * What a cell holds is drawn once: resistances, coils, capacitors, diodes, a source that follows a
 * voltage and a current inside, a part with a state of its own. Its rows are taken over by the
 * others, but where a cell has another number, or stands otherwise. The oracle knows nothing of
 * definitions: each part has the prefix of its cell. Then a cell goes and comes again beside the
 * others, whose rows are recalled. */
#include "../unit/session_kit.h"
#include "family.h"

#include "base/memory.h"
#include "base/text.h"

enum { CELLS = 8, PARTS = 7 };

typedef struct Drawn {
    int kind[PARTS];
    double value[PARTS];
    int parts;
    bool has_inner; /* another cell inside, of the first two parts alone */
} Drawn;

static const struct {
    const char *type, *key, *rest, *member; /* the last is what is asked of it */
} forms[] = {
    {"resistor", "", "", "v"},
    {"inductor", "", "/100", "i"},
    {"capacitor", "", "/1000", "v"},
    {"diode", "Is=", "*1e-9 n=1.5", "i"},
};

static void draw(Member *member, Drawn *cell)
{
    cell->parts = 2 + member_one_of(member, PARTS - 2);
    for (int k = 0; k < cell->parts; k++) {
        cell->kind[k] = member_one_of(member, COUNT(forms));
        cell->value[k] = member_between(member, 1, 9);
    }
    cell->has_inner = member_one_of(member, 2) == 0;
}

/* A ladder's cell from a to b: parts between a, a node inside, b and ground, by turns. */
static void add_parts(Text *text, const Drawn *cell, int count, const char *p, const char *a,
                      const char *b, const char *scale)
{
    char inside[40];

    (void)snprintf(inside, sizeof inside, "%sn", p);
    text_addf(text, "%sk = %s\n", p, scale);
    text_addf(text, "resistor %sR %s %s 2*%sk*shared\nresistor %sQ %s %s 3\n", p, a, inside, p, p,
              inside, b);
    for (int k = 0; k < count; k++) {
        const char *const ends[][2] = {{inside, "0"}, {b, "0"}, {inside, b}, {a, inside}};
        const char *const *between = ends[k % COUNT(ends)];
        char x[60];

        /* a resistance beside each, so that none stands alone in a circuit or a cut */
        (void)snprintf(x, sizeof x, "%sx%d", p, k);
        text_addf(text, "resistor %sS%d %s %s %.6g\n", p, k, between[0], x, 1 + cell->value[k]);
        text_addf(text, "%s %sP%d %s %s %s%.6g%s\n", forms[cell->kind[k]].type, p, k, x, between[1],
                  forms[cell->kind[k]].key, cell->value[k], forms[cell->kind[k]].rest);
    }
    text_addf(text, "vsource %sE %sy 0 0.2*%sR.v + 0.1*%sQ.i\nresistor %sT %sy %s 4\n", p, p, p, p,
              p, p, inside);
    text_addf(text, "lag %sF %sz 0 of=%sR.v T=0.01\nresistor %sW %sz %s 6\n", p, p, p, p, p,
              inside);
}

/* scale "": as the definition has it */
static void add_cell(Text *text, const Drawn *cell, bool flat, int number, const char *scale)
{
    char name[20], inner[30], a[20], b[20], node[30];

    (void)snprintf(name, sizeof name, flat ? "c%d_" : "c%d", number);
    (void)snprintf(inner, sizeof inner, "%si_", name);
    (void)snprintf(node, sizeof node, "%sn", name);
    (void)snprintf(a, sizeof a, "n%d", number);
    (void)snprintf(b, sizeof b, "n%d", number + 1);
    if (!flat) {
        text_addf(text, "use cell %s a=%s b=%s%s%s\n", name, a, b, scale[0] != '\0' ? " k=" : "",
                  scale);
        return;
    }
    add_parts(text, cell, cell->parts, name, a, b, scale[0] != '\0' ? scale : "1.5");
    if (cell->has_inner)
        add_parts(text, cell, 2, inner, node, b, "0.7");
}

static void add_definitions(Text *text, const Drawn *cell)
{
    text_add(text, "subsystem small terminals=[a, b]\n");
    add_parts(text, cell, 2, "", "a", "b", "0.7");
    text_add(text, "end\nsubsystem cell terminals=[a, b]\n");
    add_parts(text, cell, cell->parts, "", "a", "b", "1.5");
    if (cell->has_inner)
        text_add(text, "use small i a=n b=b\n");
    text_add(text, "end\n");
}

static bool runs(Member *member, Kit *kit, const char *text)
{
    if (kit_do(kit, text) == CT_OK)
        return true;
    tell(member, "%d:%d: %s\n", kit->error.line, kit->error.column, kit->error.message);
    return false;
}

static bool agree(Member *member, Kit *flat, const char *first, Kit *made, const char *second)
{
    const double x = kit_value(flat, first), y = kit_value(made, second);

    if (isnan(x) || isnan(y)) {
        tell(member, "%s %g, %s %g: %s\n", first, x, second, y, made->error.message);
        return false;
    }
    return keeps(member, second, fabs(x - y), 1e-7 * (1 + fabs(x)));
}

static bool same_cells(Member *member, const Drawn *cell, int cells, Kit *flat, Kit *made)
{
    bool same = agree(member, flat, "energy.total", made, "energy.total");

    for (int i = 0; i < cells && same; i++) {
        static const char *const asked[] = {"R.i", "E.v", "Q.power", "F.x"};
        char first[60], second[60];

        for (int k = 0; k < COUNT(asked) && same; k++) {
            (void)snprintf(first, sizeof first, "c%d_%s", i, asked[k]);
            (void)snprintf(second, sizeof second, "c%d.%s", i, asked[k]);
            same = agree(member, flat, first, made, second);
        }
        for (int k = 0; k < cell->parts && same; k++) {
            (void)snprintf(first, sizeof first, "c%d_P%d.%s", i, k, forms[cell->kind[k]].member);
            (void)snprintf(second, sizeof second, "c%d.P%d.%s", i, k, forms[cell->kind[k]].member);
            same = agree(member, flat, first, made, second);
        }
        if (same && cell->has_inner) {
            (void)snprintf(first, sizeof first, "c%d_i_E.v", i);
            (void)snprintf(second, sizeof second, "c%d.i.E.v", i);
            same = agree(member, flat, first, made, second);
        }
    }
    return same;
}

static const char run[] = "simulate 0.03 every=0.03 rtol=1e-10 atol=1e-12 method=radau\n";

/* both from their beginnings, the flat one in a session of its own */
static bool same_runs(Member *member, const Drawn *cell, int cells, const char *flat_text,
                      Kit *made)
{
    Kit flat = kit_new();
    const bool same = runs(member, &flat, flat_text) && runs(member, &flat, run) &&
                      runs(member, made, run) && same_cells(member, cell, cells, &flat, made);

    if (!same || member->told)
        tell(member, "--- flat\n%s", flat_text);
    kit_free(&flat);
    return same;
}

static Verdict cells_are_derived_alike(Member *member)
{
    static const char head[] = "shared = 1.3\nvsource V n0 0 2 + sin(50*t)\n";
    Drawn cell = {.parts = 0};
    Text flat = {0}, made = {0}, edit = {0};
    Kit kit = kit_new();
    char scale[CELLS][20];
    const int cells = 2 + member_one_of(member, CELLS - 2);
    bool same;

    draw(member, &cell);
    for (int i = 0; i < cells; i++) {
        scale[i][0] = '\0';
        if (member_one_of(member, 3) == 0)
            (void)snprintf(scale[i], sizeof scale[i], "%.6g", member_between(member, 1, 2));
    }
    text_addf(&flat, "%sresistor load n%d 0 5\n", head, cells);
    text_add(&made, flat.at);
    add_definitions(&made, &cell);
    for (int i = 0; i < cells; i++) {
        add_cell(&flat, &cell, true, i, scale[i]);
        add_cell(&made, &cell, false, i, scale[i]);
    }
    same = runs(member, &kit, made.at) && same_runs(member, &cell, cells, flat.at, &kit);
    if (same) {
        const int gone = member_one_of(member, cells);

        (void)snprintf(scale[gone], sizeof scale[gone], "%.6g", member_between(member, 1, 2));
        text_addf(&edit, "delete c%d\n", gone);
        add_cell(&edit, &cell, false, gone, scale[gone]);
        text_free(&flat);
        text_addf(&flat, "%sresistor load n%d 0 5\n", head, cells);
        for (int i = 0; i < cells; i++)
            add_cell(&flat, &cell, true, i, scale[i]);
        same = runs(member, &kit, edit.at) && same_runs(member, &cell, cells, flat.at, &kit);
    }
    if (!same || member->told)
        tell(member, "--- made\n%s%s", made.at, edit.at != NULL ? edit.at : "");
    text_free(&flat);
    text_free(&made);
    text_free(&edit);
    kit_free(&kit);
    return same ? AGREES : DISAGREES;
}

int main(int argc, char **argv)
{
    static const Family families[] = {
        {"cells_are_derived_alike", 12, 0, 0, cells_are_derived_alike},
    };

    return family_main(families, (int)(sizeof families / sizeof families[0]), argc, argv);
}
