#pragma once

#include <initializer_list>

namespace candela {

/// A shared library opened at run time, so that a machine without it still starts. Never closed: drivers
/// leave threads and exit handlers behind.
class Library {
 public:
    /// The first of `names` that opens. Throws ContextError with the loader's words if none does.
    explicit Library(std::initializer_list<const char*> names);

    /// Throws ContextError if the library has no such function.
    template <class Function>
    void find(const char* name, Function& function) const {
        function = reinterpret_cast<Function>(symbol(name));
    }

 private:
    [[nodiscard]] void* symbol(const char* name) const;

    void* handle_ = nullptr;
};

}  // namespace candela
