#pragma once

#include <candela/api.hpp>
#include <candela/error.hpp>

namespace candela {

/// An error in a scene or in the file it comes from. `what()` is one line that names the object and the
/// problem.
class CANDELA_API SceneError : public Error {
 public:
    using Error::Error;
};

}  // namespace candela
