#include "gl/renderer.h"
