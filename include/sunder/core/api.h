#pragma once

#include <cassert>

/// Marks what the shared library exports; everything else is hidden.
#if defined(SUNDER_STATIC)
#define SUNDER_API
#elif defined(_WIN32)
#if defined(SUNDER_BUILDING)
#define SUNDER_API __declspec(dllexport)
#else
#define SUNDER_API __declspec(dllimport)
#endif
#else
#define SUNDER_API [[gnu::visibility("default")]]
#endif

/// Lets compilers that can do it check the arguments of a printf format.
#if defined(__GNUC__)
#define SUNDER_PRINTF(text, first_argument) __attribute__((format(printf, text, first_argument)))
#else
#define SUNDER_PRINTF(text, first_argument)
#endif

/// A documented precondition, such as an index that is unchecked. Stops the program in debug
/// builds, does nothing where NDEBUG is defined, and never changes a layout.
#define SUNDER_ASSERT(condition) assert(condition)
