#pragma once

#include <cassert>

/// Exports a symbol from the shared library; all others are hidden.
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

/// Lets GCC and Clang check the arguments of a printf format.
#if defined(__MINGW32__)  // whose C++ library has the format of the standard, not that of Windows
#define SUNDER_PRINTF(text, first_argument) \
  __attribute__((format(gnu_printf, text, first_argument)))
#elif defined(__GNUC__)
#define SUNDER_PRINTF(text, first_argument) __attribute__((format(printf, text, first_argument)))
#else
#define SUNDER_PRINTF(text, first_argument)
#endif

/// Asserts a documented precondition, such as the range of an unchecked index. Does nothing if
/// NDEBUG is defined; never changes the layout of a type.
#define SUNDER_ASSERT(condition) assert(condition)
