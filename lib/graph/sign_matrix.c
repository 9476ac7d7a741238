/* sign_matrix.c: incidence, circuit and cutset matrices, by rows
 *
 * Incidence A = [A_T A_C] (nodes x edges) with +1 at the tail. Column c of D is the tree path from
 * tail to head of chord c. Circuits B = [-D^T 1] (chords x edges), cutsets Q = [1 D] (branches x
 * edges), so that A B^T = 0 and Q B^T = 0. */
#include "graph/tree.h"

#include <string.h>

static SignMatrix *matrix_new(int rows, int columns)
{
    SignMatrix *matrix = NEW(SignMatrix);

    matrix->rows = rows;
    matrix->columns = columns;
    matrix->start = NEW_ARRAY(int, rows + 1);
    return matrix;
}

/* allocates the entries, once start[r + 1] is the number of entries of row r */
static void lay_out(SignMatrix *matrix)
{
    for (int r = 0; r < matrix->rows; r++)
        matrix->start[r + 1] += matrix->start[r];
    matrix->column = NEW_ARRAY(int, matrix->start[matrix->rows]);
    matrix->entry = NEW_ARRAY(signed char, matrix->start[matrix->rows]);
}

void sign_matrix_free(SignMatrix *matrix)
{
    if (matrix == NULL)
        return;
    MEM_FREE(matrix->start, matrix->column, matrix->entry, matrix);
}

SignMatrix *graph_incidence(const Graph *graph, Domain domain, bool reduced)
{
    int nodes = graph_node_count(graph);
    int *row_nodes = NEW_ARRAY(int, nodes);
    int rows = 0;
    SignMatrix *matrix;

    for (int i = 0; i < nodes; i++) {
        const Node *node = graph_node(graph, i);

        if (node->domain == domain && !(reduced && node->datum))
            row_nodes[rows++] = i;
    }
    matrix = matrix_new(rows, graph_edge_count(graph));
    for (int r = 0; r < rows; r++) {
        const int *edges;

        matrix->start[r + 1] = graph_edges_at(graph, row_nodes[r], &edges);
    }
    lay_out(matrix);

    /* an edge with equal ends leaves its node as often as it enters it: 0, no entry */
    int count = 0;
    for (int r = 0; r < rows; r++) {
        const int *edges;
        int degree = graph_edges_at(graph, row_nodes[r], &edges);

        for (int k = 0; k < degree; k++) {
            const Edge *edge = graph_edge(graph, edges[k]);

            if (edge->tail == edge->head)
                continue;
            matrix->column[count] = edges[k];
            matrix->entry[count++] = edge->tail == row_nodes[r] ? 1 : -1;
        }
        matrix->start[r + 1] = count;
    }
    mem_free(row_nodes);
    return matrix;
}

/* adds an entry to a row; start[row] advances to the end of the row */
static void put(SignMatrix *matrix, int row, int column, int sign)
{
    int at = matrix->start[row]++;

    matrix->column[at] = column;
    matrix->entry[at] = (signed char)sign;
}

/* once all rows are full: sets start[row] to the beginning again */
static void wind_back(SignMatrix *matrix)
{
    memmove(matrix->start + 1, matrix->start, (size_t)matrix->rows * sizeof *matrix->start);
    matrix->start[0] = 0;
}

/* transposes the matrix; the entries of each row are ascending. O(entries). */
static SignMatrix *transpose(const SignMatrix *matrix)
{
    SignMatrix *turned = matrix_new(matrix->columns, matrix->rows);

    for (int i = 0; i < matrix->start[matrix->rows]; i++)
        turned->start[matrix->column[i] + 1]++;
    lay_out(turned);
    for (int r = 0; r < matrix->rows; r++) {
        for (int i = matrix->start[r]; i < matrix->start[r + 1]; i++)
            put(turned, matrix->column[i], r, matrix->entry[i]);
    }
    wind_back(turned);
    return turned;
}

SignMatrix *tree_circuits(const Tree *tree)
{
    const Graph *graph = tree_graph(tree);
    const int *chords = tree_chords(tree);
    SignMatrix *matrix = matrix_new(tree_chord_count(tree), graph_edge_count(graph));
    int longest = 2 * tree_branch_count(tree);
    int *edges = NEW_ARRAY(int, longest);
    int *signs = NEW_ARRAY(int, longest);
    LIST(int) columns = {0};
    LIST(signed char) entries = {0};

    LIST_ROOM(columns, matrix->rows + 1);
    LIST_ROOM(entries, matrix->rows + 1);
    for (int r = 0; r < matrix->rows; r++) {
        const Edge *chord = graph_edge(graph, chords[r]);
        int length = tree_path(tree, chord->tail, chord->head, edges, signs);

        for (int i = 0; i < length; i++) {
            LIST_PUSH(columns, edges[i]);
            LIST_PUSH(entries, (signed char)-signs[i]);
        }
        LIST_PUSH(columns, chords[r]);
        LIST_PUSH(entries, 1);
        matrix->start[r + 1] = columns.count;
    }
    MEM_FREE(edges, signs);
    matrix->column = columns.at;
    matrix->entry = entries.at;

    /* after two transpositions each circuit is in order */
    SignMatrix *turned = transpose(matrix);
    sign_matrix_free(matrix);
    matrix = transpose(turned);
    sign_matrix_free(turned);
    return matrix;
}

SignMatrix *tree_cutsets(const Tree *tree)
{
    int edges = graph_edge_count(tree_graph(tree));
    const int *branches = tree_branches(tree);
    SignMatrix *circuits = tree_circuits(tree);
    SignMatrix *matrix = matrix_new(tree_branch_count(tree), edges);
    int *row = NEW_ARRAY(int, edges);   /* of a branch, plus 1; 0 for chords */
    int *chord = NEW_ARRAY(int, edges); /* row of a chord's circuit, plus 1 */

    for (int r = 0; r < matrix->rows; r++)
        row[branches[r]] = r + 1;
    for (int r = 0; r < circuits->rows; r++)
        chord[tree_chords(tree)[r]] = r + 1;

    /* Q = [1 D]: D is the branch columns of the circuits, transposed and negated */
    for (int r = 0; r < matrix->rows; r++)
        matrix->start[r + 1] = 1;
    for (int i = 0; i < circuits->start[circuits->rows]; i++) {
        if (row[circuits->column[i]] > 0)
            matrix->start[row[circuits->column[i]]]++;
    }
    lay_out(matrix);
    for (int e = 0; e < edges; e++) {
        if (row[e] > 0)
            put(matrix, row[e] - 1, e, 1);
        if (chord[e] == 0)
            continue;
        for (int i = circuits->start[chord[e] - 1]; i < circuits->start[chord[e]]; i++) {
            if (row[circuits->column[i]] > 0)
                put(matrix, row[circuits->column[i]] - 1, e, -circuits->entry[i]);
        }
    }
    wind_back(matrix);
    MEM_FREE(row, chord);
    sign_matrix_free(circuits);
    return matrix;
}
