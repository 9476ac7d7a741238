/* initial_place_impl.h: declarations shared by the files that place frames */
#ifndef COTREE_SIMULATE_ASSEMBLE_INITIAL_PLACE_IMPL_H
#define COTREE_SIMULATE_ASSEMBLE_INITIAL_PLACE_IMPL_H

#include "simulate/assemble/assemble_limits.h"
#include "simulate/assemble/initial_impl.h"

typedef enum Knowledge { KNOWN_NOT, KNOWN_GUESSED, KNOWN_GIVEN } Knowledge;

/* a given or guessed value of a coordinate, or of a frame relative to the datum */
typedef struct InitialGuess {
    int link; /* number; -1: of a frame, */
    int head; /* this node */
    int k;    /* coordinate of the link */
    double value;
    bool is_guess;
    int group;        /* of Euler parameters given together; -1 */
    const char *name; /* of a guess, borrowed; NULL of others */
} InitialGuess;

typedef enum ColumnKind { COLUMN_SLIDE, COLUMN_TURN, COLUMN_FREE } ColumnKind;

typedef struct PlaceColumn { /* an unknown of the search */
    int link;
    ColumnKind kind;
    int k; /* shift or turn; axis of a free rotation */
} PlaceColumn;

typedef enum QueryKind { QUERY_SHIFT, QUERY_TURN, QUERY_TIE, QUERY_GUESS } QueryKind;

typedef struct Query { /* rows of the search */
    QueryKind kind;
    int link; /* or guess */
} Query;

typedef struct Placing {
    Assembly *a;
    const KinematicTree *s;
    Tree *trees[2];   /* translation, rotation */
    double *c;        /* links x POSE_COORDS */
    double *begun;    /* likewise: initial values; NAN: not known yet */
    Knowledge *known; /* likewise */
    Pose *poses;
    LIST(InitialGuess) guess_list;
    double *groups; /* x POSE_COORDS: given values of each group, 0 elsewhere */
    LIST(PlaceColumn) columns;
    LIST(Query) asks;
    int row_count, guess_count; /* the last rows belong to guesses, one each */
    double *turned, *shifted;   /* nodes x 3: turn and shift by a unit of a column */
    bool goes_on;               /* whole turns of angles are those before */
} Placing;

/* index of coordinate k of a link in arrays by link and coordinate */
static inline int place_at(int link, int k)
{
    return link * POSE_COORDS + k;
}

/* Read guesses, drivers and given values: later ones override earlier ones (initial_known.c). */
MUST_USE Status place_read_guesses(Placing *p, Diag *diag);
void place_mark_known(Placing *p);
/* How little is known of a half of a link: OPEN for each unknown coordinate, 1 for a guessed
 * one. */
enum { OPEN = 16 }; /* above the number of coordinates of a link */
int place_ignorance(const Placing *p, int link, TreeKind kind);

/* The trees that place frames, by what is known; fails as tree_complete() does. */
MUST_USE Status place_choose_trees(Placing *p, Diag *diag);
void placing_free(Placing *p); /* frees its contents */

/* Whether a link is a branch of the trees that place frames; whether a coordinate belongs to such a
 * branch. */
bool place_turns(const Placing *p, int link);
bool place_shifts(const Placing *p, int link);
bool place_has(const Placing *p, int link, int k);
void place_poses(Placing *p, const double *c);

void place_columns(Placing *p); /* list the unknowns (initial_search.c) */
/* Solve for the coordinates that the trees leave open; false: no solution was found. */
bool place_search(Placing *p, bool guesses);

/* the rows of a search and what each belongs to (initial_search.c) */
typedef struct PlaceSearch {
    Placing *p;
    Rows rows;
    LinkRow *link_rows;
    int *tails, *heads;
} PlaceSearch;

void place_open_search(PlaceSearch *search, Placing *p, bool guesses);
void place_close_search(PlaceSearch *search); /* frees its contents */
/* distance of the furthest frame from the datum, m; 1 where all are at the datum */
double place_size(const Placing *p);
/* Scale of each residual: 1/`size` for lengths (m), 1 for angles (rad), `guesses` times that for
 * guesses. After an evaluation. */
void place_row_scales(const PlaceSearch *search, double size, double guesses, double *scale);
/* the residual of guess `number` at the current poses; whether it is a length (m) */
double place_missed(Placing *p, int number, bool *is_length);

/* The assembly that meets all guesses, or the one with the least distance from them. Where no loop
 * closes from any initial point, the point where the first search ends. Without guesses nothing
 * moves (initial_guesses.c). */
void place_by_guesses(Placing *p);
/* A remark for each guess that the assembly is far from. */
void place_remark_guesses(Placing *p);

#endif
