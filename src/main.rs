//! The `trigrade` program: everything is in [`trigrade::cli`].

use std::process::ExitCode;

fn main() -> ExitCode {
    trigrade::cli::main()
}
