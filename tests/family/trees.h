/* trees.h: accelerations and torques of a tree of joints as cotree has them, by each way it may
 * take */
#ifndef COTREE_TESTS_FAMILY_TREES_H
#define COTREE_TESTS_FAMILY_TREES_H

#include <stdbool.h>
#include <stddef.h>

enum { TREES_WAYS = 24, TREES_TORQUES = 9, TREES_NAME = 16 };

/* NONE: what is there doesn't allow any way along the trees */
typedef enum TreesAnswer { TREES_FOUND, TREES_HAVE_NONE, TREES_FAILED } TreesAnswer;

typedef struct TreesModel TreesModel;

/* NULL: with a message */
TreesModel *trees_open(const char *text, char *message, size_t room);
void trees_close(TreesModel *model); /* NULL is fine */
/* u' where these coordinates and their rates are, in the order of the names; and what the way is */
TreesAnswer trees_way(TreesModel *model, int way, const char names[][TREES_NAME], const double *q,
                      const double *u, int n, double *out, char *what, size_t room);
/* as a run finds them */
TreesAnswer trees_run(TreesModel *model, const char names[][TREES_NAME], const double *q,
                      const double *u, int n, double *out);

/* torques of joints for accelerations that are asked for, and what the way is */
TreesAnswer trees_torques(TreesModel *model, int way, const char names[][TREES_NAME],
                          const double *q, const double *u, const double *acceleration, int n,
                          double *out, char *what, size_t room);
/* torques of the drivers D0, D1, ... of these coordinates, as a run finds them */
TreesAnswer trees_driven(TreesModel *model, const char names[][TREES_NAME], const double *q,
                         const double *u, int n, double *out);

#endif
