#include "renderer/gl/debug_log.hpp"

#include <algorithm>
#include <string_view>
#include <utility>

namespace candela::gl {
bool DebugMessage::is_error() const {
    return type == GL_DEBUG_TYPE_ERROR || type == GL_DEBUG_TYPE_UNDEFINED_BEHAVIOR ||
           severity == GL_DEBUG_SEVERITY_HIGH;
}

DebugLog::DebugLog(const Functions& gl, DebugReceiver receiver)
    : gl_(&gl), previous_(current()), receiver_(std::move(receiver)) {
    install({.function = &receive, .user = &self_, .enabled = true, .synchronous = true});
}

DebugLog::~DebugLog() {
    const Listener top = current();
    DebugLog* log = as_log(top);
    if (log == this) {
        install(previous_);
        return;
    }
    // A later log forwards to this one: make it forward to the listener before this one.
    for (; log; log = as_log(log->previous_)) {
        if (as_log(log->previous_) == this) log->previous_ = previous_;
    }
}

std::vector<DebugMessage> DebugLog::take() {
    return std::exchange(messages_, {});
}

void DebugLog::receive(GLenum source, GLenum type, GLuint id, GLenum severity, GLsizei length,
                       const GLchar* text, const void* user) {
    DebugLog& log = **static_cast<DebugLog* const*>(user);
    if (severity != GL_DEBUG_SEVERITY_NOTIFICATION && source != GL_DEBUG_SOURCE_SHADER_COMPILER) {
        const std::string_view whole =
            length < 0 ? std::string_view(text) : std::string_view(text, static_cast<std::size_t>(length));
        log.record(type, id, severity, std::string(whole));
    }
    const Listener& previous = log.previous_;
    if (previous.function && previous.enabled) {
        previous.function(source, type, id, severity, length, text, previous.user);
    }
}

DebugLog* DebugLog::as_log(const Listener& listener) {
    return listener.function == &receive ? *static_cast<DebugLog**>(listener.user) : nullptr;
}

DebugLog::Listener DebugLog::current() const {
    Listener listener;
    void* function = nullptr;
    gl_->GetPointerv(GL_DEBUG_CALLBACK_FUNCTION, &function);
    gl_->GetPointerv(GL_DEBUG_CALLBACK_USER_PARAM, &listener.user);
    listener.function = reinterpret_cast<GLDEBUGPROC>(function);
    listener.enabled = gl_->IsEnabled(GL_DEBUG_OUTPUT) == GL_TRUE;
    listener.synchronous = gl_->IsEnabled(GL_DEBUG_OUTPUT_SYNCHRONOUS) == GL_TRUE;
    return listener;
}

void DebugLog::install(const Listener& listener) const {
    gl_->DebugMessageCallback(listener.function, listener.user);
    set_enabled(*gl_, GL_DEBUG_OUTPUT, listener.enabled);
    set_enabled(*gl_, GL_DEBUG_OUTPUT_SYNCHRONOUS, listener.synchronous);
}

void DebugLog::record(GLenum type, GLuint id, GLenum severity, std::string text) {
    const auto same = [&](const DebugMessage& message) { return message.id == id && message.text == text; };
    const auto known = std::find_if(messages_.begin(), messages_.end(), same);
    if (known != messages_.end()) {
        ++known->times;
        return;
    }
    messages_.push_back({.type = type, .severity = severity, .id = id, .text = std::move(text)});
    if (receiver_ && messages_.back().is_error()) receiver_(messages_.back());
}

}  // namespace candela::gl
