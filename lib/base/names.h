/* names.h: from a name to a number, by hashing
 *
 * Names are in the order of their insertion. The map copies them, or borrows them all. */
#ifndef COTREE_BASE_NAMES_H
#define COTREE_BASE_NAMES_H

#include <stddef.h>

typedef struct Names Names;

Names *names_new(void);       /* new; names_free() */
Names *names_borrowing(void); /* the same; the caller's texts must outlive it */
/* the same names by the same numbers, borrowed from elsewhere: texts[number]; O(names) */
Names *names_borrowing_from(const Names *from, const char *const *texts);
void names_expect(Names *names, int more); /* room for so many is made at once */
void names_free(Names *names);
int names_find(const Names *names, const char *name);                     /* its number, or -1 */
int names_find_part(const Names *names, const char *name, size_t length); /* of its beginning */
int names_add(Names *names, const char *name);         /* found or new: 0, 1, 2 ... */
void names_trim(Names *names, int count);              /* forget those from `count` on */
const char *names_get(const Names *names, int number); /* borrowed */
int names_count(const Names *names);

#endif
