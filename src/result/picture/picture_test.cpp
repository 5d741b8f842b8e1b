#include "result/picture.h"

#include <doctest/doctest.h>
