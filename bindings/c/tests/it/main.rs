//! Programs in C and C++ against the library, compiled by the system's compilers.
#![cfg(unix)]

mod border;
mod build;
mod distributions;
mod examples;
mod header;
mod manual;
mod misuse;
mod packages;
