/* session_figure_course.h: the course of a formula over a run, in pieces
 *
 * Where rows are as dense as the integrator's steps and the formula is smooth, differences of the
 * rows bound what lies between them, and only pieces that matter to a figure are sampled. */
#ifndef COTREE_SESSION_FIGURE_COURSE_H
#define COTREE_SESSION_FIGURE_COURSE_H

#include "session/session_impl.h"

enum {
    POINTS = 7, /* of a piece, by Gauss and Legendre: exact to degree 13 */
    SAMPLES = 9 /* of a piece: these, and its ends from inside */
};

/* A part of the run without an event inside, no longer than half a step. */
typedef struct FigurePiece {
    double a, b;
    int row;      /* it lies between this row and the next; -1: not between two rows */
    double bound; /* how far the formula may leave the range of its ends; INFINITY: not known */
} FigurePiece;

typedef struct FigureCourse { /* of one formula over one run */
    ct_session *session;
    const Syntax *call;
    const Formula *formula; /* of its argument */
    Run *source, *grid;
    LIST(FigurePiece) pieces;
    double *rows;     /* the formula at each row */
    double tolerance; /* of the run, relative */
    double scale;     /* the largest size at a row */
    LIST(double) times;
    LIST(double) values;
} FigureCourse;

extern const double course_nodes[POINTS], course_weights[POINTS];

/* The pieces and the rows of a course whose first five members are set; course_free() even if it
 * fails. */
MUST_USE Status course_open(FigureCourse *course, Diag *diag);
void course_free(FigureCourse *course);
/* the formula at rising instants */
MUST_USE Status course_at(const FigureCourse *course, const double *times, int count, double *out,
                          Diag *diag);
/* Whether the formula may take a value of interest inside a piece. */
typedef bool CourseNeeds(const FigureCourse *course, const FigurePiece *piece, double level,
                         double band);
/* Set times and values of the pieces from `first` to before `end`: a sample at the start of each,
 * SAMPLES of those without a bound or that are needed, and the end of the last one. */
MUST_USE Status course_sample(FigureCourse *course, int first, int end, CourseNeeds *needs,
                              double level, double band, Diag *diag);
/* Whether the rows determine the integral of a power over a piece to `tolerance`: then sets it. */
bool course_integral(const FigureCourse *course, const FigurePiece *piece, int power,
                     double tolerance, double *out);

#endif
