/* kkt_border.h: which unknowns of [M G^T; G 0] are eliminated last
 *
 * If all speeds precede all rows, a speed that occurs in many rows couples all of these: the speeds
 * of a platform make the rows of all its legs one full block. Such speeds form the border. They are
 * eliminated after the rows that are determined by their own speeds, and the work grows linearly
 * with the number of legs. Rows that their own speeds don't determine, as of a stretched leg, come
 * last. */
#ifndef COTREE_ALGEBRA_KKT_BORDER_H
#define COTREE_ALGEBRA_KKT_BORDER_H

#include "algebra/ldl.h"

#include <stdbool.h>

/* in the order of elimination; without a border there are CLASS_OWN and CLASS_EARLY alone */
typedef enum KktClass { CLASS_OWN, CLASS_EARLY, CLASS_BORDER, CLASS_LATE } KktClass;

/* Positions of the entries: those of M, each pair once, then those of G at speed row[e] and
 * column[e], which is nu plus the number of the constraint row. Borrowed. */
typedef struct KktPlaces {
    int nu, m;
    int mass_entries, entries;
    const int *row, *column;
} KktPlaces;

#define NO_BORDER 0

/* The largest number of rows of a speed outside the border; NO_BORDER where elimination without
 * border needs fewer products. O(log m) orders are tried. */
int kkt_border(const KktPlaces *places);
/* The class of speeds and then of rows; late[k]: rows that are last in any case. */
void kkt_classes(const KktPlaces *places, int border, const bool *late, int *class);
/* number of products of a factorisation; with a border, of that of the geometry too */
double kkt_order_products(const LdlOrder *order, int border);

#endif
