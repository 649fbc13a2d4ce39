#pragma once

/// Marks what shared libraries export: functions and classes of the public API that are not inline.
#define CANDELA_API __attribute__((visibility("default")))
/// Marks private parts of exported classes.
#define CANDELA_PRIVATE __attribute__((visibility("hidden")))
