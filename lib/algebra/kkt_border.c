/* kkt_border.c: selects the border of the matrix by the cost of elimination */
#include "algebra/kkt_border.h"

#include "algebra/algebra_limits.h"
#include "base/memory.h"

#include <string.h>

/* rows that each speed has, new */
static int *count_rows(const KktPlaces *p)
{
    int *count = NEW_ARRAY(int, p->nu);

    for (int e = p->mass_entries; e < p->entries; e++)
        count[p->row[e]]++;
    return count;
}

void kkt_classes(const KktPlaces *p, int border, const bool *late, int *class)
{
    int *count = count_rows(p);

    for (int i = 0; i < p->nu; i++)
        class[i] = border != NO_BORDER && count[i] > border ? CLASS_BORDER : CLASS_OWN;
    for (int k = 0; k < p->m; k++)
        class[p->nu + k] = border != NO_BORDER ? CLASS_LATE : CLASS_EARLY;
    for (int e = p->mass_entries; e < p->entries && border != NO_BORDER; e++)
        if (class[p->row[e]] == CLASS_OWN && !late[p->column[e] - p->nu])
            class[p->column[e]] = CLASS_EARLY;
    mem_free(count);
}

double kkt_order_products(const LdlOrder *order, int border)
{
    return (double)ldl_order_products(order) *
           (border != NO_BORDER ? KKT_BORDER_FACTORISATIONS : 1);
}

static double products(const KktPlaces *p, int border)
{
    const int size = p->nu + p->m;
    int *class = NEW_ARRAY(int, size), *place_of = NEW_ARRAY(int, size);
    int *place = NEW_ARRAY(int, p->entries);
    bool *late = NEW_ARRAY(bool, p->m);
    LdlOrder *order;
    double out;

    kkt_classes(p, border, late, class);
    order = ldl_order_new(size, class, p->entries, p->row, p->column, place, place_of);
    out = kkt_order_products(order, border);
    ldl_order_free(order);
    MEM_FREE(class, place_of, place, late);
    return out;
}

int kkt_border(const KktPlaces *p)
{
    int *count, most = 0, best = NO_BORDER;
    double least;

    if (p->nu + p->m <= KKT_BORDER_LEAST_SIZE)
        return NO_BORDER;
    count = count_rows(p);
    for (int i = 0; i < p->nu; i++)
        most = count[i] > most ? count[i] : most;
    mem_free(count);
    if (most <= KKT_BORDER_FEWEST_ROWS)
        return NO_BORDER;
    least = products(p, NO_BORDER);
    for (int border = KKT_BORDER_FEWEST_ROWS; border < most; border *= 2) {
        const double tried = products(p, border);

        if (tried < least) {
            least = tried;
            best = border;
        }
    }
    return best;
}
