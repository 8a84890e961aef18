#pragma once
// Loops compiled once for each instruction set, of which the program takes its machine's when it starts. Private to
// files of such loops.

#if defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_ADDRESS__)
#define GONIOFIT_CLONES __attribute__((target_clones("default", "arch=x86-64-v3", "arch=x86-64-v4")))
#else
#define GONIOFIT_CLONES
#endif
