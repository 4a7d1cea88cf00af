#include "host/parallel/subnormals.hpp"

#if defined(__SSE3__)
    #include <pmmintrin.h>
#endif

namespace selvage {

void flush_subnormals()
{
#if defined(__SSE3__)
    _MM_SET_FLUSH_ZERO_MODE(_MM_FLUSH_ZERO_ON);
    _MM_SET_DENORMALS_ZERO_MODE(_MM_DENORMALS_ZERO_ON);
#endif
}

}  // namespace selvage
