/* spice_models.c: models and keys of elements of a netlist, and values as functions of temperature
 *
 * R, L, C over the temperature: ngspice manual, chapter 3; diodes: chapter 7. */
#include "export/spice_impl.h"

#include <ctype.h>
#include <math.h>
#include <string.h>
#include <strings.h>

const char *spice_lower(Import *import, const char *word)
{
    char *copy = pool_text(import->pool, word, strlen(word));

    for (char *c = copy; *c != '\0'; c++)
        *c = (char)tolower((unsigned char)*c);
    return copy;
}

bool spice_read(Spice *s, const char *text, SpiceValue *out)
{
    s->why = NULL;
    return spice_value(s->import, text, out, &s->why);
}

/* the number in a text, or `other` */
bool spice_value_or(Spice *s, const char *text, const char *other, SpiceValue *out)
{
    return spice_read(s, text != NULL && text[0] != '\0' ? text : other, out);
}

/* the model of that name and type, or NULL and why */
const DeviceModel *spice_find_model(Spice *s, const char *name, const char *type, const char **why)
{
    int i = names_find(s->model_names, spice_lower(s->import, name));

    if (i < 0 && s->outer != NULL)
        return spice_find_model(s->outer, name, type, why);
    if (i >= 0 && strcmp(s->models.at[i].type, type) == 0)
        return &s->models.at[i];
    *why = i < 0 ? import_text(s->import, "there is no .model %s", name)
                 : import_text(s->import, "its .model %s is of type %s, not %s", name,
                               s->models.at[i].type, type);
    return NULL;
}

bool spice_model_value(Spice *s, const DeviceModel *model, const char *name, const char *other,
                       SpiceValue *out)
{
    return spice_value_or(s, card_key(model->card, MODEL_KEYS, name), other, out);
}

/* False: a key of the card changes values and isn't supported; the element is omitted. Keys without
 * effect are reported in a remark. */
/* in small or capital letters */
static bool is_listed(const char *names, const char *word)
{
    for (; *names != '\0'; names += strcspn(names, " "), names += strspn(names, " "))
        if (strcspn(names, " ") == strlen(word) && strncasecmp(names, word, strlen(word)) == 0)
            return true;
    return false;
}

bool spice_check_keys(Spice *s, const Card *element, const Card *card, int first,
                      const SpiceKey *keys)
{
    const bool is_model = card->words.at[0][0] == '.';
    const char *owner =
        is_model ? import_text(s->import, ".model %s", card->words.at[1]) : card->words.at[0];
    Text others = {0};
    bool good = true;

    for (int i = first; i < card->words.count && good; i++) {
        const SpiceKey *key = keys;
        double number;

        if (!card_is_key(card, i))
            continue;
        while (key->names != NULL && !is_listed(key->names, card->words.at[i]))
            key++;
        if (key->names != NULL && key->effect == WITHOUT_EFFECT)
            text_addf(&others, "%s%s", others.length > 0 ? " " : "", card->words.at[i]);
        good =
            key->names != NULL && (key->effect <= WITHOUT_EFFECT ||
                                   (key->effect == REFUSED_UNLESS_ZERO &&
                                    spice_number(card_word(card, i + 2), &number) && number == 0));
        if (!good)
            import_leave(s->import, card->line, true, element->words.at[0],
                         "%s= of %s%s%s%s isn't modelled; delete it where it has no effect",
                         card->words.at[i], owner, key->names != NULL ? " (" : "",
                         key->names != NULL ? key->meaning : "", key->names != NULL ? ")" : "");
    }
    if (good && others.length > 0)
        import_leave(s->import, card->line, false,
                     import_text(s->import, "%s of %s", others.at, card->words.at[is_model]),
                     "it changes no value here");
    text_free(&others);
    return good;
}

/* --- temperatures --- */

SpiceValue spice_times(Spice *s, SpiceValue a, SpiceValue b)
{
    const char *alone;

    if (a.is_number && b.is_number)
        return spice_of(s->import, a.number * b.number);
    alone = import_text(s->import, "%s*%s", a.text, b.text);
    return (SpiceValue){.text = import_text(s->import, "(%s)", alone), .alone = alone};
}

/* T and Tnom of an element, degrees Celsius: temp= of the element, or the circuit's and its dtemp=;
 * tnom= of its model, or the circuit's. Numbers only: false and why otherwise. */
static bool read_temperatures(Spice *s, const Card *card, int first, const DeviceModel *model,
                              double *temperature, double *nominal)
{
    const char *given = card_key(card, first, "temp"), *above = card_key(card, first, "dtemp");
    const char *reference = model != NULL ? card_key(model->card, MODEL_KEYS, "tnom") : NULL;
    SpiceValue at, more, from;

    if (model != NULL && reference == NULL)
        reference = card_key(model->card, MODEL_KEYS, "t_measured");
    if (!spice_value_or(s, given, "0", &at) || !spice_value_or(s, above, "0", &more) ||
        !spice_value_or(s, reference, "0", &from))
        return false;
    if (!at.is_number || !more.is_number || !from.is_number) {
        s->why = "its temperature is no number";
        return false;
    }
    *temperature = given != NULL ? at.number : s->temperature + more.number;
    *nominal = reference != NULL ? from.number : s->nominal;
    return true;
}

/* 1 + tc1*dT + tc2*dT^2, dT = T - Tnom; coefficients of the element before those of its model */
bool spice_temperature_factor(Spice *s, const Card *card, const DeviceModel *model, SpiceValue *out)
{
    static const char *const names[] = {"tc1", "tc2"};
    SpiceValue coefficients[2];
    double temperature, nominal, dt;

    if (!read_temperatures(s, card, 3, model, &temperature, &nominal))
        return false;
    dt = temperature - nominal;
    for (int k = 0; k < 2; k++) {
        const char *given = card_key(card, 3, names[k]);

        for (int i = 3; given == NULL && i < card->words.count; i++)
            if (card_is_key(card, i) && spice_is(card->words.at[i], "tc") &&
                i + 2 + k < card->words.count && !card_is_key(card, i + 2 + k))
                given = card->words.at[i + 2 + k];
        if (given == NULL && model != NULL)
            given = card_key(model->card, MODEL_KEYS, names[k]);
        if (!spice_value_or(s, given, "0", &coefficients[k]))
            return false;
    }
    if (dt == 0)
        *out = spice_of(s->import, 1);
    else if (coefficients[0].is_number && coefficients[1].is_number)
        *out = spice_of(s->import, 1 + dt * (coefficients[0].number + dt * coefficients[1].number));
    else
        *out =
            (SpiceValue){.text = import_text(s->import, "(1 + %s*%s + %s*%s)", coefficients[0].text,
                                             import_number(s->import, dt), coefficients[1].text,
                                             import_number(s->import, dt * dt))};
    if (out->alone == NULL)
        out->alone = out->text;
    return true;
}

/* Is and n of the exponential at 27 degrees that is the diode at T (ngspice manual, 7.2):
 *   Is(T) = Is * (T/Tnom)^(xti/n) * exp((T/Tnom - 1)*eg/(n*Vt)), Vt = k*T/q
 *   n*k*T/q = n'*k*300.15/q, n' = n*T/300.15
 * eg in V, temperatures in K. False: the reason is `why`. */
bool spice_heat_diode(Spice *s, const Card *card, const DeviceModel *model, SpiceValue *is,
                      SpiceValue *n)
{
    static const double kelvin = 273.15, reference = 300.15;
    static const double volt_per_kelvin = 1.38064852e-23 / 1.6021766208e-19; /* k/q */
    double temperature, nominal, ratio;
    SpiceValue eg, xti;

    if (!read_temperatures(s, card, 4, model, &temperature, &nominal) ||
        !spice_model_value(s, model, "eg", "1.11", &eg) ||
        !spice_model_value(s, model, "xti", "3", &xti))
        return false;
    if (temperature == nominal && temperature + kelvin == reference)
        return true;
    if (!n->is_number || !eg.is_number || !xti.is_number || !(n->number > 0) ||
        !(temperature > -kelvin) || !(nominal > -kelvin)) {
        s->why = "its temperature is another than 27 degrees, and n=, eg= or xti= is no number";
        return false;
    }
    temperature += kelvin;
    ratio = temperature / (nominal + kelvin);
    *is = spice_times(
        s, *is,
        spice_of(s->import, exp(((ratio - 1) * eg.number / (volt_per_kelvin * temperature) +
                                 xti.number * log(ratio)) /
                                n->number)));
    *n = spice_of(s->import, n->number * temperature / reference);
    return true;
}
