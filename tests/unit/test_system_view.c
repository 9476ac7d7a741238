/* test_system_view.c: a System stays as it was made, whatever its views form of it, and all of its
 * views form the same */
#include "scene.h"

#include "formulate/system/constraints.h"
#include "formulate/system/dynamics.h"
#include "formulate/system/kinematics.h"
#include "formulate/system/network.h"
#include "formulate/system/origin.h"
#include "formulate/system/shown.h"
#include "formulate/system/system_impl.h"

#include <string.h>

/* chords, drivers, reactions beside redundant rows, switches, a motor and a spring across a line */
#define FOUR_BAR                                                                                   \
    "gravity [0, -9.81, 0]\n"                                                                      \
    "body m1 mass=1 inertia=[0.1, 0.1, 0.2]\nbody m2 mass=2 inertia=[0.1, 0.2, 0.3]\n"             \
    "body m3 mass=1 inertia=[0.1, 0.1, 0.1]\n"                                                     \
    "arm a1 m1 [1, 0, 0]\narm a2 m2 [2, 0, 0]\narm a3 m3 [1, 0, 0]\narm w ground [2, 0, 0]\n"      \
    "revolute h1 ground m1\nrevolute h2 a1 m2\nrevolute h3 a2 a3\nrevolute h4 w m3\n"              \
    "spring k1 ground a2 k=20 length=0.4\n"                                                        \
    "motor M1 h1 a 0 R=1.2 L=0.05 Kt=0.8 Kv=0.8\nvsource V1 a 0 if(t < 0.5, 12, -6)\n"             \
    "diode D1 a b\nresistor R1 b 0 R=1\ncapacitor C1 b 0 C=1e-3\ntree joint\n"

static const char *const names[] = {
    "h1.fx", "h3.fy", "h4.tz", "h2.effort", "m2.ax", "a3.x", "energy.kinetic", "energy.potential",
    "M1.i",  "R1.v",  "C1.i",  "D1.power",  "h4'",   "h4''", "k1.effort",
};

/* --- what is compared --- */

/* bytes of a System and of its parts, one after another */
static void add_bytes(Text *text, const void *bytes, size_t size)
{
    const unsigned char *at = bytes;

    for (size_t i = 0; i < size; i++)
        text_addf(text, "%02x", at[i]);
    text_char(text, '\n');
}

#define ADD_LIST(text, list) add_bytes(text, (list).at, (size_t)(list).count * sizeof *(list).at)

static char *picture(const System *system)
{
    const Kinematics *kinematics = system->kinematics;
    const size_t frames = (size_t)graph_node_count(system->origin->graph);
    Text text = {0};

    add_bytes(&text, system, sizeof *system);
    add_bytes(&text, system->origin, sizeof *system->origin);
    add_bytes(&text, kinematics, sizeof *kinematics);
    add_bytes(&text, kinematics->frames, frames * sizeof *kinematics->frames);
    ADD_LIST(&text, kinematics->chains);
    ADD_LIST(&text, kinematics->q);
    ADD_LIST(&text, kinematics->u);
    add_bytes(&text, system->constraints, sizeof *system->constraints);
    ADD_LIST(&text, system->constraints->rows);
    ADD_LIST(&text, system->constraints->redundant_rows);
    add_bytes(&text, system->dynamics, sizeof *system->dynamics);
    add_bytes(&text, system->network, sizeof *system->network);
    ADD_LIST(&text, system->network->branches);
    ADD_LIST(&text, system->network->unknowns);
    ADD_LIST(&text, system->network->unknown_of);
    add_bytes(&text, system->shown, sizeof *system->shown);
    text_addf(&text, "%zu\n", pool_bytes(system->pool));
    return text_done(&text);
}

typedef LIST(Expr) Exprs;

static void form_all(System *view, Exprs *out)
{
    const Switch *switches;
    SystemSurface surface;
    int of_time;
    const int count = system_switches(view, &switches, &of_time);

    for (int i = 0; i < count; i++)
        LIST_PUSH(*out, switches[i].condition);
    for (int i = 0; system_surface(view, i, &surface); i++)
        LIST_PUSH(*out, surface.condition);
    for (Block block = 0; block < BLOCK_EMBEDDED_MASS; block++) {
        int rows, columns;

        system_block_size(view, block, &rows, &columns);
        for (int i = 0; i < rows * columns; i++) {
            Expr entry = NULL;

            EXPECT(system_show(view, block, i / columns, i % columns, &entry, NULL) == OK);
            LIST_PUSH(*out, entry);
        }
    }
    for (int i = 0; i < COUNT(names); i++) {
        Expr value = NULL;
        Diag diag = {0};

        /* one that can't be determined can't in either */
        if (system_variable(view, names[i], 0, &value, &diag) != OK)
            value = NULL;
        LIST_PUSH(*out, value);
    }
    LIST_PUSH(*out, system_kinetic(view));
    LIST_PUSH(*out, system_potential(view));
    LIST_PUSH(*out, system_power(view));
}

static const System *formed_of(const Model *model)
{
    const SystemOptions options = {.form = NETWORK_STATE};
    const System *formed = NULL;
    Scene scene = {0};
    Diag diag = {0};

    EXPECT(model_scene(model, &scene, &diag) == OK);
    EXPECT(system_new(&scene, &options, &formed, &diag) == OK);
    scene_free(&scene);
    return formed;
}

/* --- claims --- */

static void views_form_the_same_of_a_system_that_stays_as_it_was_made(const char *text)
{
    Model *model = scene_new(text);
    const System *formed = formed_of(model);
    System *one = system_view(formed), *other = system_view(formed);
    char *before = picture(formed), *after;
    Exprs of_one = {0}, of_other = {0};
    int known = 0;

    form_all(one, &of_one);
    form_all(other, &of_other);
    after = picture(formed);
    EXPECT_TEXT(after, before);
    EXPECT(of_one.count == of_other.count);
    for (int i = 0; i < of_one.count && i < of_other.count; i++) {
        EXPECT(of_one.at[i] == of_other.at[i]);
        known += of_one.at[i] != NULL;
    }
    EXPECT(known >= of_one.count - 2); /* redundant rows leave some reactions open */
    mem_free(before);
    mem_free(after);
    LIST_FREE(of_one);
    LIST_FREE(of_other);
    system_free(one);
    system_free(other);
    system_free(formed);
    model_free(model);
}

static void a_four_bar_with_a_motor_stays_as_it_was_made(void)
{
    views_form_the_same_of_a_system_that_stays_as_it_was_made(FOUR_BAR);
}

static void its_absolute_coordinates_do_so_too(void)
{
    views_form_the_same_of_a_system_that_stays_as_it_was_made(FOUR_BAR "tree absolute\n");
}

static void views_outlive_each_other(void)
{
    Model *model = scene_new(FOUR_BAR);
    const System *formed = formed_of(model);
    System *one = system_view(formed), *other;
    Expr first = NULL, second = NULL;
    Diag diag = {0};

    EXPECT(system_variable(one, "energy.kinetic", 0, &first, &diag) == OK);
    system_free(one);
    other = system_view(formed);
    EXPECT(system_variable(other, "energy.kinetic", 0, &second, &diag) == OK);
    EXPECT(first != NULL && first == second);
    system_free(other);
    system_free(formed);
    model_free(model);
}

/* how many systems the modes of six ideal diodes are */
static int systems_of_modes(const char *text)
{
    Model *model = scene_new(text);
    const System *formed = formed_of(model);
    System *whole = system_view(formed);
    System *seen[64] = {NULL};
    int systems = 0;
    Diag diag = {0};

    for (int sides = 0; sides < 64; sides++) {
        bool closed[6];
        System *mode = NULL;
        int k = 0;

        for (int i = 0; i < 6; i++)
            closed[i] = (sides >> i & 1) != 0;
        EXPECT(system_mode(whole, model_scene_source(model), closed, NULL, &mode, &diag) == OK);
        while (k < systems && seen[k] != mode)
            k++;
        if (k == systems)
            seen[systems++] = mode;
    }
    system_free(whole);
    system_free(formed);
    model_free(model);
    return systems;
}

/* six rectifiers behind resistors, the last of them behind this */
#define RECTIFIERS(last)                                                                           \
    "vsource V a 0 sin(t)\n"                                                                       \
    "resistor R1 a b1 1\ndiode D1 b1 c1\ncapacitor C1 c1 0 1\n"                                    \
    "resistor R2 a b2 1\ndiode D2 b2 c2\ncapacitor C2 c2 0 1\n"                                    \
    "resistor R3 a b3 1\ndiode D3 b3 c3\ncapacitor C3 c3 0 1\n"                                    \
    "resistor R4 a b4 1\ndiode D4 b4 c4\ncapacitor C4 c4 0 1\n"                                    \
    "resistor R5 a b5 1\ndiode D5 b5 c5\ncapacitor C5 c5 0 1\n" last                               \
    " a b6 1\ndiode D6 b6 c6\ncapacitor C6 c6 0 1\n"

/* Behind the first eight one system is all of them, with numbers for sides. Where the last diode,
 * closed, lays its capacitor beside the source it takes a state away, by a wire or another
 * capacitor before it: then each of those has its own. */
static void modes_that_keep_the_states_are_one_system(void)
{
    EXPECT(systems_of_modes(RECTIFIERS("resistor R6")) == 8 + 1);
    EXPECT(systems_of_modes(RECTIFIERS("capacitor R6")) == 8 + 1 + 32);
}

int main(void)
{
    RUN(a_four_bar_with_a_motor_stays_as_it_was_made);
    RUN(its_absolute_coordinates_do_so_too);
    RUN(views_outlive_each_other);
    RUN(modes_that_keep_the_states_are_one_system);
    return test_end();
}
