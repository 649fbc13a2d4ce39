#pragma once

// The private headers of the engine with which the app reads and writes its files, and quotes them in
// messages, as the importer does.

#include "engine/import/exr.hpp"
#include "engine/import/output_files.hpp"
#include "engine/import/shortest.hpp"
#include "engine/import/unit_length.hpp"
#include "engine/json/json.hpp"
#include "engine/readable.hpp"
