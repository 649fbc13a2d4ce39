#pragma once

#include <candela/api.hpp>
#include <candela/error.hpp>

namespace candela::tools {

/// A file that cannot be written, or pictures that cannot be compared.
class CANDELA_API ToolError : public Error {
 public:
    using Error::Error;
};

}  // namespace candela::tools
