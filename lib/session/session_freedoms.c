/* session_freedoms.c: compares trees that have virtual joints among their branches with trees of
 * real edges */
#include "session/session_impl.h"

#include "simulate/analyse/freedoms.h"

#include <string.h>

typedef struct Branches { /* virtual ones */
    LIST(const Instance *) joints;
    LIST(const char *) ends; /* tail and head of each */
} Branches;

static void branches_free(Branches *branches)
{
    LIST_FREE(branches->joints);
    LIST_FREE(branches->ends);
}

static Status find_branches(const Model *model, Branches *out, Diag *diag)
{
    const Tree *trees[TREE_KINDS] = {NULL};
    const Graph *graph = model_graph(model);
    Status status;

    CHECK(model_trees(model, trees, diag));
    for (int i = 0; trees[TREE_TRANSLATION] != NULL && i < model_count(model); i++) {
        const Instance *joint = model_instance(model, i);

        if (!joint->is_virtual || joint->edge < 0 ||
            (!tree_has(trees[TREE_TRANSLATION], joint->edge) &&
             !tree_has(trees[TREE_ROTATION], joint->edge)))
            continue;
        LIST_PUSH(out->joints, joint);
        LIST_PUSH(out->ends, graph_node(graph, joint->tail)->name);
        LIST_PUSH(out->ends, graph_node(graph, joint->head)->name);
    }
done:
    return status;
}

/* the scene in the trees of `tree joint` */
typedef struct RealTrees {
    const Model *model;
    Tree *halves[2];
} RealTrees;

static Status make_real(const void *context, Scene *out, Diag *diag)
{
    const RealTrees *real = context;
    Status status = model_scene(real->model, out, diag);

    out->trees[TREE_TRANSLATION] = real->halves[0];
    out->trees[TREE_ROTATION] = real->halves[1];
    return status;
}

/* the same start in trees of real edges; *out NULL where there is none to compare with */
static Status assemble_real(ct_session *session, const SimulationInput *setting, System **system,
                            Result **out, ResultReader **reader, Diag *diag)
{
    RealTrees trees = {.model = session->model};
    SystemOptions options = {.form =
                                 (NetworkForm)model_setting_value(session->model, SETTING_NETWORK),
                             .watch = &session->watch};
    SimulationInput plain = *setting;
    Scene scene = {0};
    Status status;

    plain.form = FORM_AUGMENTED;
    plain.independent_count = 0;
    plain.scene = (SceneSource){make_real, &trees};
    CHECK(model_preset_trees(session->model, false, trees.halves, diag));
    CHECK(make_real(&trees, &scene, diag));
    CHECK(system_new_view(&scene, &options, system, diag));
    CHECK(run_assemble(*system, &plain, out, reader, diag));
done:
    scene_free(&scene);
    tree_free(trees.halves[0]);
    tree_free(trees.halves[1]);
    return status == E_STOPPED ? status : OK;
}

Status session_check_freedoms(ct_session *session, System *system, const SimulationInput *setting,
                              Diag *diag)
{
    Branches branches = {0};
    System *real_system = NULL;
    Result *real = NULL, *with = NULL;
    ResultReader *real_reader = NULL, *with_reader = NULL;
    SimulationInput plain = *setting;
    Status status = OK;
    Diag ignored;

    if (session->covered == model_revision(session->model) + 1)
        return OK;
    CHECK(find_branches(session->model, &branches, diag));
    if (branches.joints.count == 0)
        goto done;
    CHECK(assemble_real(session, setting, &real_system, &real, &real_reader, diag));
    plain.form = FORM_AUGMENTED;
    plain.independent_count = 0;
    /* a start that can't be found has its own message, from the run */
    if (real == NULL || run_assemble(system, &plain, &with, &with_reader, &ignored) != OK)
        goto done;
    CHECK(freedoms_compare(real_reader, with_reader, branches.joints.at,
                           (const char *const(*)[2])(const void *)branches.ends.at,
                           branches.joints.count, diag));
    session->covered = model_revision(session->model) + 1;
done:
    result_reader_free(real_reader);
    result_reader_free(with_reader);
    result_free(real);
    result_free(with);
    system_free(real_system);
    branches_free(&branches);
    return status;
}

Status session_try_trees(ct_session *session, Diag *diag)
{
    RunInput input = {0};
    Result *result = NULL;
    System *system;
    Diag why;
    Status status = session_running(session, &system, &why);

    if (status != OK)
        return OK;
    run_input_make(session, system, &input);
    status = session_check_freedoms(session, system, &input.setting, &why);
    if (status == E_BRANCH && diag != NULL)
        *diag = why;
    if (status == OK && run_assemble(system, &input.setting, &result, NULL, &why) == OK)
        session_note_freedoms(session, result);
    result_free(result);
    run_input_free(&input);
    return status == E_BRANCH ? status : OK;
}

void session_remark_free(ct_session *session)
{
    Branches branches = {0};

    if (find_branches(session->model, &branches, NULL) == OK)
        for (int i = 0; i < branches.joints.count; i++)
            if (strcmp(branches.joints.at[i]->row->name, "free") == 0)
                text_addf(&session->remarks,
                          "%s covers every motion of its frames: it adds coordinates, and the "
                          "equations of what it displaced\n",
                          branches.joints.at[i]->name);
    branches_free(&branches);
}
