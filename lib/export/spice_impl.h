/* spice_impl.h: state of the translation of a netlist, for the files that do it */
#ifndef COTREE_EXPORT_SPICE_IMPL_H
#define COTREE_EXPORT_SPICE_IMPL_H

#include "export/spice_cards.h"
#include "export/spice_source.h"

typedef struct DeviceModel {
    const char *type; /* lower case */
    const Card *card;
} DeviceModel;

typedef struct ParameterCard {
    const char *name; /* lower case */
    const char *written;
    const char *value;
    int line;
    enum { WAITING, ON_ITS_WAY, SAID } state;
} ParameterCard;

/* the netlist, or a .subckt of it */
typedef struct Spice {
    struct Spice *outer; /* the enclosing one; NULL: the netlist */
    Card head;           /* .subckt NAME NODE... [KEY=VALUE...] */
    const char *name;    /* of the subsystem, ours */
    LIST(struct Spice *) inner;
    enum { UNSAID, BEGUN, DEFINED } definition;
    ImportScope scope; /* names inside */
    Import *import;
    Cards cards;
    LIST(DeviceModel) models;
    Names *model_names;
    LIST(ParameterCard) parameters;
    Names *parameter_names;
    int depth;                   /* of parameters that need others */
    SpiceTimes times;            /* of .tran */
    const Card *tran;            /* NULL: none */
    bool uses_initial;           /* uic: start from initial values, not from an operating point */
    double temperature, nominal; /* temp and tnom of the circuit, degrees Celsius */
    const char *why;             /* the last value could not be read */
    Diag *diag;
} Spice;

/* a value; false: the reason is s->why */
bool spice_read(Spice *s, const char *text, SpiceValue *out);
/* the number in a text or, if `text` is NULL or empty, `other` */
bool spice_value_or(Spice *s, const char *text, const char *other, SpiceValue *out);
SpiceValue spice_times(Spice *s, SpiceValue a, SpiceValue b);
const char *spice_lower(Import *import, const char *word);
const char *spice_node(Spice *s, const char *name);
void spice_write_initial(Spice *s, int line, const char *variable, SpiceValue v);

/* parameters of a card, from word `first` on */
void spice_read_parameters(Spice *s, const Card *card, int first);
/* parameters, those taken before and those of .param, and models */
void spice_write_values(Spice *s);
/* All elements get their names before one is written, and before nodes get theirs. Cards without
 * translation are no elements from then on. */
void spice_name_elements(Spice *s);
void spice_write_elements(Spice *s);
/* whether an element is connected to the node, or only reads its voltage */
bool spice_node_is_used(const Spice *s, const char *name);

enum { MODEL_KEYS = 3 }; /* the first word of a model that may be a key */
/* the model of that name and type, or NULL and why */
const DeviceModel *spice_find_model(Spice *s, const char *name, const char *type, const char **why);
bool spice_model_value(Spice *s, const DeviceModel *model, const char *name, const char *other,
                       SpiceValue *out);

/* what keys of an element or of a model do here; rows of an array end with names NULL */
typedef struct SpiceKey {
    const char *names; /* blanks between */
    enum { TAKEN, WITHOUT_EFFECT, REFUSED_UNLESS_ZERO, REFUSED } effect;
    const char *meaning; /* of what is refused */
} SpiceKey;

/* False: a key of the card changes values and isn't supported; the element is omitted. Keys without
 * effect are reported in a remark. */
bool spice_check_keys(Spice *s, const Card *element, const Card *card, int first,
                      const SpiceKey *keys);

/* The factor of R, L or C (`model` or NULL) at its temperature; Is and n of a diode there. False:
 * the reason is s->why. */
bool spice_temperature_factor(Spice *s, const Card *card, const DeviceModel *model,
                              SpiceValue *out);
bool spice_heat_diode(Spice *s, const Card *card, const DeviceModel *model, SpiceValue *is,
                      SpiceValue *n);

/* the first word from `first` on that is a key, or announces keys; nodes and names end there */
int spice_first_key(const Card *card, int first);
/* the .subckt that a card X calls, of those inside and around; NULL */
Spice *spice_find_subcircuit(const Spice *s, const Card *card);
enum { FIRST_PORT = 2 }; /* words of .subckt */
int spice_port_count(const Spice *subcircuit);

#endif
