/* shared_text.h: texts that are the same in all exported code: files of share, a line each, NULL at
 * their ends */
#ifndef COTREE_EXPORT_SHARED_TEXT_H
#define COTREE_EXPORT_SHARED_TEXT_H

extern const char *const shared_text_fmu_h[],
    *const shared_text_fmu_c[],
        *const shared_text_fmu_step_c[],
            *const shared_text_fmu_ahead_c[],
                *const shared_text_fmu_open_c[],
                    *const shared_text_fmu_values_c[],
                        *const shared_text_fmu_slide_c[],
                            *const shared_text_complementarity_h[],
                                *const shared_text_complementarity_c[],
                                    *const shared_text_norm_complementarity_h[],
                                        *const shared_text_norm_complementarity_c[],
                                            *const shared_text_surface_sides_h[],
                                                *const shared_text_surface_sides_c[],
                                                    *const shared_text_row_closure_h[],
                                                        *const shared_text_row_closure_c[],
                                                            *const shared_text_fmi_h[],
                                                                *const shared_text_fmi2_c[],
                                                                    *const shared_text_fmi3_c[],
                                                                        *const shared_text_modes_c[],
                                                                            *const shared_text_modes_step_c
                                                                                [],
                                                                                    *const
                                                                                        shared_text_open_c
                                                                                            [];

#endif
