/* kkt_border.h: which unknowns of [M G^T; G 0] wait for others
 *
 * Where all speeds go before all rows, what one speed shares among many rows couples these: the
 * speeds of a platform make the rows of all its legs one full block. So such speeds, the border,
 * wait until rows are eliminated that their own speeds determine; the work then rises as the number
 * of legs. Rows that their own speeds don't determine, as where a leg is stretched, come last. */
#ifndef COTREE_ALGEBRA_KKT_BORDER_H
#define COTREE_ALGEBRA_KKT_BORDER_H

#include "algebra/ldl.h"

#include <stdbool.h>

/* in the order of elimination; without a border there are CLASS_OWN and CLASS_EARLY alone */
typedef enum KktClass { CLASS_OWN, CLASS_EARLY, CLASS_BORDER, CLASS_LATE } KktClass;

/* Where the entries stand: of M, each pair once, then those of G at speed row[e] and column[e], nu
 * plus the row's number. Borrowed. */
typedef struct KktPlaces {
    int nu, m;
    int mass_entries, entries;
    const int *row, *column;
} KktPlaces;

#define NO_BORDER 0

/* How many rows a speed may have before it is of the border; NO_BORDER where elimination in full is
 * cheaper by the products that both take. O(log m) orders are tried. */
int kkt_border(const KktPlaces *places);
/* The class of speeds and then of rows; late[k]: rows that come last in any case. */
void kkt_classes(const KktPlaces *places, int border, const bool *late, int *class);
/* products that a factorisation takes; with a border of the geometry, too */
double kkt_order_products(const LdlOrder *order, int border);

#endif
