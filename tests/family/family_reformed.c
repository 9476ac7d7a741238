/* family_reformed.c: equations formed after edits are those of the edited model typed anew, bit for
 * bit (reformed.h)
 *
 * Bodies and joints are added, removed and inserted, numbers and trees change, instances of
 * subsystems come and go, and edits are undone. The programs of both are the same text, instruction
 * by instruction.
 */
#include "edits.h"
#include "reformed.h"

/* a body between one and the joint of the next */
static void add_insertion(Draft *draft, Text *text, int number)
{
    const int i = 1 + below(draft, draft->bodies - 1);

    text_addf(text, "delete j%d\nbody n%d mass=1.5 inertia=", i, number);
    add_inertia(draft, text);
    text_addf(text, "\narm e%d n%d ", number, number);
    add_vector(draft, text);
    text_addf(text, "\nrevolute k%d t%d n%d\nrevolute j%d e%d h%d\ntree joint\n", number, i, number,
              i, number, i);
}

/* after each change: its statements are in `lines` */
static Verdict change(Member *member, Reformed *reformed, const char *lines)
{
    Text story = {0};
    const Reform reform = reformed_change(reformed, lines, &story);

    tell(member, "%s", story.at);
    text_free(&story);
    return reform == REFORM_SAME ? AGREES : reform == REFORM_REFUSED ? REFUSED : DISAGREES;
}

static Verdict edited_bodies_are_typed_anew(Member *member)
{
    Draft draft = {.member = member, .is_large = member_one_of(member, 2) == 0};
    Reformed *reformed = reformed_new(member_one_of(member, 2) == 0);
    Text lines = {0};
    Verdict verdict = AGREES;
    int agreed = 0;

    add_model(&draft, &lines);
    for (int k = 0; k <= EDITS && verdict != DISAGREES; k++) {
        verdict = change(member, reformed, lines.at);
        agreed += verdict == AGREES;
        text_free(&lines);
        if (draft.bodies > 1 && below(&draft, 4) == 0)
            add_insertion(&draft, &lines, k);
        else
            add_edit(&draft, &lines);
    }
    text_free(&lines);
    reformed_free(reformed);
    return verdict == DISAGREES ? DISAGREES : agreed > 0 ? AGREES : REFUSED;
}

static Verdict edited_instances_are_typed_anew(Member *member)
{
    Robot robot = {.member = member};
    Reformed *reformed = reformed_new(member_one_of(member, 2) == 0);
    Text lines = {0};
    Verdict verdict = AGREES;
    int agreed = 0;

    add_robot(&robot, &lines);
    for (int k = 0; k <= CHANGES && verdict != DISAGREES; k++) {
        verdict = change(member, reformed, lines.at);
        agreed += verdict == AGREES;
        text_free(&lines);
        add_change(&robot, &lines);
    }
    text_free(&lines);
    reformed_free(reformed);
    return verdict == DISAGREES ? DISAGREES : agreed > 0 ? AGREES : REFUSED;
}

static const Family families[] = {
    {"equations after edits are those of the model typed anew", 12, 0.1, 0,
     edited_bodies_are_typed_anew},
    {"equations after instances came and went are those of the model typed anew", 6, 0.3, 0,
     edited_instances_are_typed_anew},
};

int main(int argc, char **argv)
{
    return family_main(families, COUNT(families), argc, argv);
}
