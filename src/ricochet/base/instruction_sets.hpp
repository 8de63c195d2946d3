#pragma once

/// @file Loops compiled for several instruction sets. Not part of the public interface.
///
/// The program is compiled for any x86-64; functions marked so take wider registers where the processor has them, and
/// may round a product and a sum once where it can do both at once: bits are those of the machine.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__)
#define RICOCHET_EACH_INSTRUCTION_SET __attribute__((target_clones("arch=x86-64-v4", "arch=x86-64-v3", "default")))
#else
#define RICOCHET_EACH_INSTRUCTION_SET
#endif

/// A template that such functions call, to be compiled as a part of each.
#if defined(__GNUC__)
#define RICOCHET_PART_OF_CALLER __attribute__((always_inline)) inline
#else
#define RICOCHET_PART_OF_CALLER inline
#endif
