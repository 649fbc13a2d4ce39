#pragma once

#include <candela/gl_loader.hpp>

namespace candela::sandbox {

/// A GL context for a thread of its own.
class ThreadContext {
 public:
    ThreadContext() = default;
    virtual ~ThreadContext() = default;
    ThreadContext(const ThreadContext&) = delete;
    ThreadContext& operator=(const ThreadContext&) = delete;

    /// Makes it current in the calling thread.
    virtual void make_current() = 0;
    /// Called in that thread when it needs the context no more.
    virtual void release() = 0;
    [[nodiscard]] virtual gl::GetProc functions() const = 0;
};

}  // namespace candela::sandbox
