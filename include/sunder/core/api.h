#pragma once

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
