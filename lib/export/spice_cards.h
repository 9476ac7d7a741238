/* spice_cards.h: lines of a netlist as cards
 *
 * A card is a line and its continuation lines (+). Words are separated by blanks, commas, brackets
 * and equal signs; case is ignored. */
#ifndef COTREE_EXPORT_SPICE_CARDS_H
#define COTREE_EXPORT_SPICE_CARDS_H

#include "export/import.h"

typedef struct Card {
    int line;
    int element;              /* row of elements[]; -1: none */
    LIST(const char *) words; /* in the import's pool; "=" is one */
} Card;
typedef LIST(Card) Cards;

/* the same word, whatever the case */
bool spice_is(const char *a, const char *b);
/* Lines to cards, which are added; the first is the title. Lines between .control and .endc are
 * commands, and omitted. */
void cards_read(Import *import, const char *text, size_t length, Cards *out);
const char *card_word(const Card *card, int i); /* "": there is none */
bool card_is_key(const Card *card, int i);      /* followed by "=" */
/* value of the key from word `first` on; NULL: none */
const char *card_key(const Card *card, int first, const char *name);

#endif
