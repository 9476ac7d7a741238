/* complete_members.c: completions after dots and keys */
#include "present/complete_impl.h"
#include "present/count.h"

#include <ctype.h>
#include <stdio.h>
#include <string.h>

void offer_key_value(TypedLine *line, const Verb *verb, const char *key)
{
    const Param *param = key_param(line, verb, key);
    const VerbKey *row = verb->keys;

    while (row != NULL && (row->name == NULL || strcmp(row->name, key) != 0))
        row = row->name != NULL ? row + 1 : NULL;
    if (verb->offers == OFFERS_SETTABLE && offer_setting(line, key))
        return;
    if (param != NULL && param->kind == PARAM_WORD)
        offer_alternatives(line, param->fallback);
    else if (param != NULL && (param->kind == PARAM_AXIS || param->kind == PARAM_AXES))
        offer_alternatives(line, "x|y|z|-x|-y|-z");
    else if (row != NULL && row->words != NULL)
        offer_alternatives(line, row->words);
    else if (row == NULL || !offer_source(line, row->offers))
        offer_values(line);
}

static void offer_member(TypedLine *line, const char *base, const char *member)
{
    Text word = {0};

    text_addf(&word, "%s.%s", base, member);
    offer(line, word.at);
    text_free(&word);
}

void offer_members(TypedLine *line, const Verb *verb)
{
    char base[128];
    const char *dot = strrchr(line->prefix, '.');
    const Graph *graph = model_graph(line->known->model);
    const Instance *instance;
    const Member *member;
    const char *begun;
    int node;

    (void)snprintf(base, sizeof base, "%.*s", (int)(dot - line->prefix), line->prefix);
    for (int i = 0; whole_name(i) != NULL; i++)
        for (int k = 0; strcmp(whole_name(i), base) == 0 && whole_member(i, k) != NULL; k++)
            offer_member(line, base, whole_member(i, k));
    for (int i = 0; strcmp(base, "count") == 0 && count_block_name(i) != NULL; i++)
        offer_member(line, base, count_block_name(i));
    instance = model_owner(line->known->model, line->prefix, &begun);
    if (instance == NULL && model_use_around(line->known->model, line->prefix) >= 0)
        offer_names(line); /* what an instance has of its own */
    if (instance == NULL) {
        node = graph_find_node(graph, base);
        if (node >= 0)
            offer_member(line, base, domain_across(graph_node(graph, node)->domain));
        return;
    }
    if (verb != NULL && verb->offers == OFFERS_SETTABLE) {
        for (int i = 0; i < instance->row->param_count; i++)
            offer_member(line, instance->name, instance->row->params[i].name);
        return;
    }
    for (int c = 0; c < instance->coord_count; c++)
        offer(line, instance->coord[c]);
    for (int i = 0;
         (member = component_member(instance->row, model_is_planar(line->known->model), i)) != NULL;
         i++)
        offer_member(line, instance->name, member->name);
}
