#pragma once

#include <stdexcept>

#include <candela/api.hpp>

namespace candela {

/// An error in a scene or in the file it comes from. `what()` is one line that names the object and the
/// problem.
class CANDELA_API SceneError : public std::runtime_error {
 public:
    using std::runtime_error::runtime_error;
};

}  // namespace candela
