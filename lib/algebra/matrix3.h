/* matrix3.h: vectors of three and rotations, row by row; outputs may be inputs */
#ifndef COTREE_ALGEBRA_MATRIX3_H
#define COTREE_ALGEBRA_MATRIX3_H

double vector3_dot(const double a[3], const double b[3]);
void vector3_cross(const double a[3], const double b[3], double out[3]);
void vector3_across(const double u[3], double out[3]); /* a unit vector square to u */

void matrix3_one(double R[9]);
void matrix3_transpose(const double R[9], double out[9]);
void matrix3_times(const double A[9], const double B[9], double out[9]);
void matrix3_apply(const double R[9], const double v[3], double out[3]);
void matrix3_turn(const double axis[3], double angle, double out[9]); /* about a unit vector */
/* Euler parameters, scalar part first, to the rotation and back: of unit length, the first of them
 * that isn't 0 positive */
void matrix3_of_parameters(const double p[4], double R[9]);
void matrix3_parameters(const double R[9], double p[4]);
/* axis times angle of a rotation, rad; at half a turn either sense */
void matrix3_log(const double R[9], double out[3]);

#endif
