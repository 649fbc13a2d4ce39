#pragma once

#include <initializer_list>

namespace candela {

/// A shared library that is loaded at run time, so that the program also starts on a machine without it. It
/// is never unloaded, because drivers leave threads and exit handlers behind.
class Library {
 public:
    /// Loads the first of `names` that can be loaded. Throws ContextError with the loader's message for the
    /// first name if none can.
    explicit Library(std::initializer_list<const char*> names);

    /// Sets `function` to the address of `name`. Throws ContextError if the library has no such function.
    template <class Function>
    void find(const char* name, Function& function) const {
        function = reinterpret_cast<Function>(symbol(name));
    }

 private:
    [[nodiscard]] void* symbol(const char* name) const;

    void* handle_ = nullptr;
};

}  // namespace candela
