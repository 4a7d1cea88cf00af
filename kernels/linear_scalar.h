// The scalar type of the linear solver's matrices and vectors. A source file that includes this header is compiled once
// per precision. Sums over vectors are always accumulated in double.
#pragma once
#include "portable.h"
#ifdef SELVAGE_LINEAR
typedef SELVAGE_LINEAR linear;
#else
typedef float linear;
#endif
