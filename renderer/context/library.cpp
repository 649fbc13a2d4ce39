#include "renderer/context/library.hpp"

#include <dlfcn.h>
#include <fmt/format.h>

#include <string>

#include <candela/headless_context.hpp>

namespace candela {

Library::Library(std::initializer_list<const char*> names) {
    std::string first_error;
    for (const char* name : names) {
        handle_ = dlopen(name, RTLD_NOW | RTLD_LOCAL);
        if (handle_) return;
        if (first_error.empty())
            first_error = dlerror();  // NOLINT(concurrency-mt-unsafe): glibc keeps one per thread
    }
    throw ContextError(first_error);
}

void* Library::symbol(const char* name) const {
    void* address = dlsym(handle_, name);
    if (!address) throw ContextError(fmt::format("the library has no {}", name));
    return address;
}

}  // namespace candela
