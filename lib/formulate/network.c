/* network.c: scalar domains in state form
 *
 * A normal tree takes voltage sources first, then capacitors, resistors, inductors, current
 * sources last. States are the voltages of branch capacitors and the currents of chord
 * inductors; every other voltage and current follows along circuits and cutsets. Where
 * following a resistor leads back to itself its own variable stays unknown (z). Left over is
 * A [x'; z] = r. theory.md 8. */
#include "formulate/system_impl.h"

#include <string.h>

/* members that tell across and through variable, by domain */
static const char *const across_member[] = {"", "v", "p", "w", "v", "T"};
static const char *const through_member[] = {"", "i", "flow", "torque", "force", "heat"};

static const Instance *owner_of(const System *system, const Branchlike *branch)
{
    return &system->instances[branch->instance];
}

static const char *member_name(System *system, const Branchlike *branch, bool through)
{
    Domain domain = graph_edge(system->graph, branch->edge)->domain;

    return system_keep(system, "%s.%s", owner_of(system, branch)->name,
                       through ? through_member[domain] : across_member[domain]);
}

static TreeKind kind_of(const System *system, const Branchlike *branch)
{
    Domain domain = graph_edge(system->graph, branch->edge)->domain;
    TreeKind kind = TREE_ELECTRICAL;

    while (tree_kind_domain(kind) != domain)
        kind++;
    return kind;
}

/* --- relations --- */

static Status read_relation(System *system, Branchlike *branch, Diag *diag)
{
    const Instance *instance = owner_of(system, branch);
    Expr zero = expr_int(system->arena, 0);
    Motion1 motion = {zero, zero, zero, zero};
    Relation relation = {.value = zero, .series = zero, .offset = zero};
    Status status = OK;

    if (instance->joint >= 0) {
        const Instance *joint = &system->instances[instance->joint];

        CHECK(coordinate_value(system, joint, instance->joint_coordinate, 0, &motion.displacement,
                               diag));
        CHECK(coordinate_value(system, joint, instance->joint_coordinate, 1, &motion.rate, diag));
    }
    instance->row->relation(instance, system->arena, &motion, &relation);
    branch->relation = relation;
    for (int i = 0; i < system->drives.count; i++)
        if (system->drives.at[i].by_source &&
            system->instances[system->drives.at[i].instance].by == branch->instance)
            branch->relation.value = system->drives.at[i].effort;
done:
    return status;
}

/* expressions of the relation over the system's variables; the user's variables in them may be
 * others of the network, so this is done when a value is wanted, not before */
static Status resolve_relation(System *system, Branchlike *branch, Diag *diag)
{
    Relation *relation = &branch->relation;
    Status status = OK;

    CHECK(resolve(system, relation->value, &relation->value, diag));
    CHECK(resolve(system, relation->series, &relation->series, diag));
    CHECK(resolve(system, relation->offset, &relation->offset, diag));
done:
    return status;
}

/* --- the normal tree --- */

static Status normal_tree(System *system, TreeKind kind, Diag *diag)
{
    static const int order[] = {[RELATION_ACROSS] = 0,
                                [RELATION_CAPACITIVE] = 1,
                                [RELATION_RESISTIVE] = 2,
                                [RELATION_INDUCTIVE] = 3,
                                [RELATION_THROUGH] = 4};
    int *preference = NEW_ARRAY(int, graph_edge_count(system->graph));
    TreeChoice choice = {.preference = preference};
    Tree *tree = NULL;
    Status status = OK;

    for (int i = 0; i < system->branches.count; i++)
        preference[system->branches.at[i].edge] = order[system->branches.at[i].relation.kind];
    CHECK(tree_complete(system->graph, kind, &choice, false, &tree, diag));
    tree_free(system->trees[kind]);
    system->trees[kind] = tree;
done:
    mem_free(preference);
    return status;
}

/* names of the edges of a circuit or cutset that a source stands in, for messages */
static const char *edge_names(System *system, const SignMatrix *matrix, int row)
{
    Text names = {0};
    const char *kept;

    for (int i = matrix->start[row]; i < matrix->start[row + 1]; i++)
        text_addf(&names, "%s%s", i > matrix->start[row] ? " " : "",
                  graph_edge(system->graph, matrix->column[i])->name);
    kept = system_keep(system, "%s", names.at != NULL ? names.at : "");
    text_free(&names);
    return kept;
}

/* a voltage source that closes a circuit, a current source that cuts the network */
static Status check_sources(System *system, TreeKind kind, Diag *diag)
{
    const Tree *tree = system->trees[kind];
    SignMatrix *circuits = tree_circuits(tree);
    SignMatrix *cutsets = tree_cutsets(tree);
    Status status = OK;

    for (int i = 0; i < system->branches.count && status == OK; i++) {
        const Branchlike *branch = &system->branches.at[i];

        if (kind_of(system, branch) != kind)
            continue;
        if (branch->relation.kind == RELATION_ACROSS && !branch->branch) {
            for (int r = 0; r < circuits->rows; r++)
                if (tree_chords(tree)[r] == branch->edge) {
                    status = diag_set(diag, E_MODEL, "the sources %s form a circuit",
                                      edge_names(system, circuits, r));
                    diag_hint(diag, "put a resistance into it, or leave one of them out");
                }
        }
        if (branch->relation.kind == RELATION_THROUGH && branch->branch) {
            for (int r = 0; r < cutsets->rows; r++)
                if (tree_branches(tree)[r] == branch->edge) {
                    status = diag_set(diag, E_MODEL,
                                      "nothing but the sources %s joins two parts of the network",
                                      edge_names(system, cutsets, r));
                    diag_hint(diag, "put a resistance across one of them");
                }
        }
    }
    sign_matrix_free(circuits);
    sign_matrix_free(cutsets);
    return status;
}

/* --- across and through variables --- */

static Expr new_unknown(System *system, Branchlike *branch)
{
    bool through = !branch->branch;
    const char *name = member_name(system, branch, through);
    Expr symbol = expr_symbol(system->arena, name, SYMBOL_ALGEBRAIC);

    branch->unknown = system->z.count;
    LIST_PUSH(system->z, (Variable){.name = name,
                                    .symbol = symbol,
                                    .edge = branch->edge,
                                    .instance = branch->instance});
    return symbol;
}

/* an edge met again while it is followed: a resistor keeps its own variable, others can't */
static Status met_again(System *system, Branchlike *branch, Expr *out, Diag *diag)
{
    if (branch->relation.kind != RELATION_RESISTIVE) {
        (void)diag_set(diag, E_MODEL, "%s depends on itself through the network",
                       owner_of(system, branch)->name);
        diag_hint(diag, "put a resistor or a capacitor between the source and what it reads");
        return E_MODEL;
    }
    *out =
        branch->unknown >= 0 ? system->z.at[branch->unknown].symbol : new_unknown(system, branch);
    return OK;
}

/* sum of across variables along the tree path from tail to head */
static Status circuit_across(System *system, Branchlike *branch, Expr *out, Diag *diag)
{
    const Edge *edge = graph_edge(system->graph, branch->edge);
    const Tree *tree = system->trees[kind_of(system, branch)];
    int room = tree_depth(tree, edge->tail) + tree_depth(tree, edge->head);
    int *edges = NEW_ARRAY(int, room);
    int *signs = NEW_ARRAY(int, room);
    Expr *terms = NEW_ARRAY(Expr, room);
    int count = tree_path(tree, edge->tail, edge->head, edges, signs);
    Status status = OK;

    for (int i = 0; i < count; i++) {
        Branchlike *other = &system->branches.at[system->scalar_of_edge[edges[i]]];
        Expr v;

        CHECK(network_across(system, other, &v, diag));
        terms[i] = signs[i] > 0 ? v : expr_neg(system->arena, v);
    }
    *out = expr_sum(system->arena, terms, count);
done:
    mem_free(edges);
    mem_free(signs);
    mem_free(terms);
    return status;
}

/* minus the sum of the chords' through variables in the cutset */
static Status cutset_through(System *system, Branchlike *branch, Expr *out, Diag *diag)
{
    const Tree *tree = system->trees[kind_of(system, branch)];
    const int *chords = tree_chords(tree);
    LIST(Expr) terms = {0};
    Status status = OK;

    for (int c = 0; c < tree_chord_count(tree); c++) {
        const Edge *chord = graph_edge(system->graph, chords[c]);
        int out_of = (int)tree_is_beyond(tree, branch->edge, chord->tail);
        int into = (int)tree_is_beyond(tree, branch->edge, chord->head);
        bool forward = tree_is_forward(tree, tree_far_node(tree, branch->edge));
        int sign = (out_of - into) * (forward ? 1 : -1);
        Expr i;

        if (sign == 0)
            continue;
        CHECK(network_through(system, &system->branches.at[system->scalar_of_edge[chords[c]]], &i,
                              diag));
        LIST_PUSH(terms, sign > 0 ? i : expr_neg(system->arena, i));
    }
    *out = expr_sum(system->arena, terms.at, terms.count);
done:
    LIST_FREE(terms);
    return status;
}

static Expr affine(Arena *arena, Expr a, Expr x, Expr b)
{
    return expr_add(arena, expr_mul(arena, a, x), b);
}

static Status branch_across(System *system, Branchlike *branch, Expr *out, Diag *diag)
{
    Arena *arena = system->arena;
    const Relation *relation = &branch->relation;
    Expr i;
    Status status = OK;

    if (relation->kind == RELATION_ACROSS) {
        *out = relation->value;
        return OK;
    }
    if (branch->state >= 0) {
        *out = system->x.at[branch->state].symbol;
        return OK;
    }
    CHECK(network_through(system, branch, &i, diag));
    *out = affine(arena, relation->value, i, relation->offset);
    if (relation->kind == RELATION_INDUCTIVE) {
        /* an inductor among inductors: its current is theirs */
        CHECK(rate_of(system, i, out, diag));
        *out = affine(arena, relation->value, *out,
                      affine(arena, relation->series, i, relation->offset));
    } else if (branch->unknown >= 0) {
        *out = system->z.at[branch->unknown].symbol;
    }
done:
    return status;
}

static Status chord_through(System *system, Branchlike *branch, Expr *out, Diag *diag)
{
    Arena *arena = system->arena;
    const Relation *relation = &branch->relation;
    Expr v;
    Status status = OK;

    if (relation->kind == RELATION_THROUGH) {
        *out = relation->value;
        return OK;
    }
    if (branch->state >= 0) {
        *out = system->x.at[branch->state].symbol;
        return OK;
    }
    CHECK(network_across(system, branch, &v, diag));
    if (relation->kind == RELATION_CAPACITIVE) {
        /* a capacitor among capacitors and sources: its voltage is theirs */
        CHECK(rate_of(system, v, out, diag));
        *out = affine(arena, relation->value, *out, relation->offset);
    } else if (branch->unknown >= 0) {
        *out = system->z.at[branch->unknown].symbol;
    } else {
        *out = expr_div(arena, expr_sub(arena, v, relation->offset), relation->value);
    }
done:
    return status;
}

Status network_across(System *system, Branchlike *branch, Expr *out, Diag *diag)
{
    Status status = OK;

    if (branch->v == NULL) {
        bool entered = branch->branch;

        if (entered && branch->busy)
            return met_again(system, branch, out, diag);
        if (entered) {
            branch->busy = true;
            CHECK(resolve_relation(system, branch, diag));
        }
        CHECK(branch->branch ? branch_across(system, branch, out, diag)
                             : circuit_across(system, branch, out, diag));
        branch->v = expr_hold(system->arena, *out);
        branch->busy = branch->busy && !entered;
    }
    *out = branch->v;
done:
    return status;
}

Status network_through(System *system, Branchlike *branch, Expr *out, Diag *diag)
{
    Status status = OK;

    if (branch->i == NULL) {
        bool entered = !branch->branch;

        if (entered && branch->busy)
            return met_again(system, branch, out, diag);
        if (entered) {
            branch->busy = true;
            CHECK(resolve_relation(system, branch, diag));
        }
        CHECK(branch->branch ? cutset_through(system, branch, out, diag)
                             : chord_through(system, branch, out, diag));
        branch->i = expr_hold(system->arena, *out);
        branch->busy = branch->busy && !entered;
    }
    *out = branch->i;
done:
    return status;
}

/* --- building --- */

static void add_states(System *system)
{
    for (int i = 0; i < system->branches.count; i++) {
        Branchlike *branch = &system->branches.at[i];
        bool through = branch->relation.kind == RELATION_INDUCTIVE;
        const char *name;

        if (!(branch->relation.kind == RELATION_CAPACITIVE && branch->branch) &&
            !(through && !branch->branch))
            continue;
        name = member_name(system, branch, through);
        branch->state = system->x.count;
        LIST_PUSH(system->x, (Variable){.name = name,
                                        .symbol = expr_symbol(system->arena, name, SYMBOL_STATE),
                                        .edge = branch->edge,
                                        .instance = branch->instance});
        name = system_keep(system, "%s'", name);
        LIST_PUSH(system->rates, expr_symbol(system->arena, name, SYMBOL_STATE_RATE));
    }
}

static void add_branches(System *system)
{
    int count = graph_edge_count(system->graph);

    system->scalar_of_edge = pool_alloc(system->pool, (size_t)count * sizeof(int));
    for (int e = 0; e < count; e++) {
        const Edge *edge = graph_edge(system->graph, e);

        system->scalar_of_edge[e] = -1;
        if (edge->domain == DOMAIN_MECHANICAL)
            continue;
        system->scalar_of_edge[e] = system->branches.count;
        LIST_PUSH(system->branches,
                  (Branchlike){.edge = e, .instance = edge->component, .state = -1, .unknown = -1});
    }
}

Status network_build(System *system, Diag *diag)
{
    Expr value;
    Status status = OK;

    add_branches(system);
    for (int i = 0; i < system->branches.count; i++)
        CHECK(read_relation(system, &system->branches.at[i], diag));
    for (TreeKind kind = TREE_ELECTRICAL; kind < TREE_KINDS; kind++) {
        if (system->trees[kind] == NULL)
            continue;
        CHECK(normal_tree(system, kind, diag));
        for (int i = 0; i < system->branches.count; i++)
            if (kind_of(system, &system->branches.at[i]) == kind)
                system->branches.at[i].branch =
                    tree_has(system->trees[kind], system->branches.at[i].edge);
        CHECK(check_sources(system, kind, diag));
    }
    add_states(system);
    for (int i = 0; i < system->branches.count; i++) {
        CHECK(network_across(system, &system->branches.at[i], &value, diag));
        CHECK(network_through(system, &system->branches.at[i], &value, diag));
        CHECK(poll(system->watch));
    }
done:
    return status;
}

/* --- equations: own relation of each unknown, A w = r --- */

static Status residual(System *system, Branchlike *branch, Expr *leading, Expr *rest, Diag *diag)
{
    Arena *arena = system->arena;
    const Relation *relation = &branch->relation;
    Expr v;
    Expr i;
    Expr rate = branch->state >= 0 ? system->rates.at[branch->state] : NULL;
    Status status = OK;

    CHECK(branch->branch ? cutset_through(system, branch, &i, diag)
                         : network_through(system, branch, &i, diag));
    CHECK(branch->branch ? network_across(system, branch, &v, diag)
                         : circuit_across(system, branch, &v, diag));
    if (relation->kind == RELATION_CAPACITIVE) {
        *leading = expr_mul(arena, relation->value, rate);
        *rest = expr_sub(arena, i, relation->offset);
    } else if (relation->kind == RELATION_INDUCTIVE) {
        *leading = expr_mul(arena, relation->value, rate);
        *rest = expr_sub(arena, v, affine(arena, relation->series, i, relation->offset));
    } else if (branch->branch) {
        *leading = system->z.at[branch->unknown].symbol;
        *rest = affine(arena, relation->value, i, relation->offset);
    } else {
        *leading = expr_mul(arena, relation->value, system->z.at[branch->unknown].symbol);
        *rest = expr_sub(arena, v, relation->offset);
    }
done:
    return status;
}

static Status equation_row(System *system, int row, const Branchlike *branch, const Expr *unknowns,
                           const Expr *zeros, Diag *diag)
{
    Arena *arena = system->arena;
    int count = system->x.count + system->z.count;
    const unsigned solved = 1U << SYMBOL_STATE_RATE | 1U << SYMBOL_ALGEBRAIC;
    Expr leading = system->network_left.at[row];
    Expr all =
        expr_sub(arena, expr_open(arena, leading), expr_open(arena, system->network_right.at[row]));

    for (int k = 0; k < count; k++) {
        Expr slope = expr_diff(arena, all, unknowns[k]);

        if ((expr_kinds(slope) & solved) != 0)
            return diag_set(diag, E_MISSING, "%s: a nonlinear relation comes with a later version",
                            owner_of(system, branch)->name);
        system->run.network[row * count + k] = slope;
    }
    system->run.network_rhs[row] =
        expr_neg(arena, expr_substitute(arena, all, unknowns, zeros, count));
    return OK;
}

Status network_equations(System *system, Diag *diag)
{
    Arena *arena = system->arena;
    int count = system->x.count + system->z.count;
    Expr *unknowns = NEW_ARRAY(Expr, count);
    Expr *zeros = NEW_ARRAY(Expr, count);
    Status status = OK;

    system->run.network = pool_alloc(system->pool, (size_t)count * (size_t)count * sizeof(Expr));
    system->run.network_rhs = pool_alloc(system->pool, (size_t)count * sizeof(Expr));
    for (int k = 0; k < count; k++) {
        const Variable *variable =
            k < system->x.count ? &system->x.at[k] : &system->z.at[k - system->x.count];
        Branchlike *branch = &system->branches.at[system->scalar_of_edge[variable->edge]];
        Expr leading;
        Expr rest;

        unknowns[k] = k < system->x.count ? system->rates.at[k] : variable->symbol;
        zeros[k] = expr_int(arena, 0);
        CHECK(residual(system, branch, &leading, &rest, diag));
        LIST_PUSH(system->network_left, leading);
        LIST_PUSH(system->network_right, expr_fold(arena, expr_open(arena, rest)));
    }
    for (int k = 0; k < count; k++) {
        const Variable *variable =
            k < system->x.count ? &system->x.at[k] : &system->z.at[k - system->x.count];

        CHECK(equation_row(system, k, &system->branches.at[system->scalar_of_edge[variable->edge]],
                           unknowns, zeros, diag));
    }
done:
    mem_free(unknowns);
    mem_free(zeros);
    return status;
}
