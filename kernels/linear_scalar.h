// The scalar type of the linear solver's matrices and vectors. A source file that includes this is built once per
// precision; sums over vectors are always taken in double.
#pragma once
#include "portable.h"
#ifdef SELVAGE_LINEAR
typedef SELVAGE_LINEAR linear;
#else
typedef float linear;
#endif
