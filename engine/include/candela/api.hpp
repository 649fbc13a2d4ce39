#pragma once

#if defined(_WIN32)  // only static libraries, which export nothing
#define CANDELA_API
#define CANDELA_PRIVATE
#else
/// Marks what shared libraries export: functions and classes of the public API that are not inline.
#define CANDELA_API __attribute__((visibility("default")))
/// Marks private parts of exported classes.
#define CANDELA_PRIVATE __attribute__((visibility("hidden")))
#endif
