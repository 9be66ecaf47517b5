#include "scenes/library.h"
