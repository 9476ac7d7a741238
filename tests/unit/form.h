/* form.h: the equations of a model as it is, for unit tests and benchmarks */
#ifndef COTREE_TESTS_FORM_H
#define COTREE_TESTS_FORM_H

#include "formulate/system/system.h"
#include "model/model.h"

__attribute__((unused)) static Status form_system(const Model *model, System **out, Diag *diag)
{
    const SystemOptions options = {.form =
                                       (NetworkForm)model_setting_value(model, SETTING_NETWORK)};
    Scene scene = {0};
    Status status = OK;

    CHECK(model_scene(model, &scene, diag));
    CHECK(system_new_view(&scene, &options, out, diag));
done:
    scene_free(&scene);
    return status;
}

#endif
