// Makes Catch2 2 define the test runner here; version 3 brings it as a library.
#define CATCH_CONFIG_MAIN
#include "validation/unit/catch.hpp"
