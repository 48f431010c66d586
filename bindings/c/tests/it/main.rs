//! Programs in C and C++ against the library, compiled by the system's compilers.
#![cfg(unix)]

mod build;
mod distributions;
mod examples;
mod ffi;
mod header;
mod manual;
mod misuse;
mod packages;
