//! One run of a foreign program, with limits: its crashes, hangs and children stay its own.

use super::running::Running;
use std::fs::{self, File};
use std::io::{self, Read, Seek, SeekFrom};
use std::path::Path;
use std::process::{Child, Command, ExitStatus, Stdio};
use std::time::{Duration, Instant};

/// Limits of one run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limits {
    /// Processor time of a program, kept in whole seconds by the shell's `ulimit -t`: so a busy machine
    /// makes no hangs. One that waits for ever is ended after a few times as much by the clock.
    /// On Windows it is time by the clock.
    pub time: Duration,
    /// Address space in bytes. Kept by the shell's `ulimit -v`, where that works (Linux, the BSDs);
    /// macOS and Windows have no such limit and ignore it.
    pub memory: u64,
}

/// How a run ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ending {
    /// With this exit code.
    Exit(i32),
    /// By this signal.
    Signal(i32),
    /// It was killed, with its children, when its time was up.
    TimedOut,
}

/// A run that is over.
#[derive(Clone, Debug, PartialEq)]
pub struct Ended {
    /// How.
    pub ending: Ending,
    /// The end of what it printed on standard output and standard error.
    pub said: String,
    /// How long it took.
    pub time: Duration,
}

/// As much of the output is kept.
const TAIL: u64 = 2000;
/// Times by the clock that a program may take of its processor time.
const PATIENCE: u32 = if cfg!(unix) { 5 } else { 1 };
/// The signal of a program whose processor time is up, the same on Linux, macOS and the BSDs.
#[cfg(unix)]
const SIGXCPU: i32 = 24;

/// Runs a command line in a folder by the shell.
///
/// # Errors
/// When the shell cannot be started, or the folder not written, or an interrupt ended all runs.
pub fn execute(
    command: &str,
    folder: &Path,
    limits: &Limits,
    running: &Running,
) -> io::Result<Ended> {
    let path = folder.join("output.txt");
    let output = File::create(&path)?;
    let mut shell = shell(command, limits);
    shell.current_dir(folder).stdin(Stdio::null());
    shell.stdout(output.try_clone()?).stderr(output);
    let start = Instant::now();
    let mut child = running.start(&mut shell, folder)?;
    let status = wait(&mut child, start, limits.time * PATIENCE);
    // Whatever it started and left behind goes with it.
    running.end(&child);
    let status = status?;
    let status = match status {
        Some(status) => Some(status),
        None => {
            child.kill().ok();
            child.wait()?;
            None
        }
    };
    let time = start.elapsed();
    let ending = status.map_or(Ending::TimedOut, ending);
    Ok(Ended { ending, said: tail(&path)?, time })
}

/// Waits for the end, looking ever less often; `None` when the time is up.
fn wait(child: &mut Child, start: Instant, time: Duration) -> io::Result<Option<ExitStatus>> {
    let mut pause = Duration::from_micros(500);
    loop {
        if let Some(status) = child.try_wait()? {
            return Ok(Some(status));
        }
        if start.elapsed() >= time {
            return Ok(None);
        }
        std::thread::sleep(pause);
        pause = (pause * 2).min(Duration::from_millis(20));
    }
}

/// A shell in a process group of its own. The limit on file size keeps a chatterbox from filling the
/// disk. The limits on processor time hold where its parent was killed, too; the second one is for
/// programs that catch the signal of the first.
#[cfg(unix)]
fn shell(command: &str, limits: &Limits) -> Command {
    use std::os::unix::process::CommandExt;
    let kilobytes = limits.memory / 1024;
    let seconds = limits.time.as_millis().div_ceil(1000).max(1);
    let (soft, hard) = (seconds, 2 * seconds);
    let script = format!(
        "ulimit -v {kilobytes} 2>/dev/null; ulimit -S -t {soft} 2>/dev/null; \
         ulimit -H -t {hard} 2>/dev/null; ulimit -c 0 2>/dev/null; ulimit -f 8388608 2>/dev/null; {command}"
    );
    let mut shell = Command::new("sh");
    shell.args(["-c", &script]).process_group(0);
    shell
}

/// The command line goes to `cmd` as it stands: it does not know the quoting that arguments get.
#[cfg(windows)]
fn shell(command: &str, _limits: &Limits) -> Command {
    use std::os::windows::process::CommandExt;
    let mut shell = Command::new("cmd");
    shell.raw_arg("/S /C").raw_arg(format!("\"{command}\""));
    shell
}

#[cfg(not(any(unix, windows)))]
fn shell(command: &str, _limits: &Limits) -> Command {
    Command::new(command)
}

#[cfg(unix)]
fn ending(status: ExitStatus) -> Ending {
    use std::os::unix::process::ExitStatusExt;
    match (status.signal(), status.code()) {
        (Some(SIGXCPU), _) => Ending::TimedOut,
        // A shell tells of a signal in this way.
        (None, Some(code)) if code == 128 + SIGXCPU => Ending::TimedOut,
        (Some(signal), _) => Ending::Signal(signal),
        (None, Some(code @ 129..=192)) => Ending::Signal(code - 128),
        (None, code) => Ending::Exit(code.unwrap_or(-1)),
    }
}

#[cfg(not(unix))]
fn ending(status: ExitStatus) -> Ending {
    match status.code() {
        // Windows has no signals: an exception is a negative exit code.
        Some(code) if code < 0 => Ending::Signal(code),
        code => Ending::Exit(code.unwrap_or(-1)),
    }
}

fn tail(path: &Path) -> io::Result<String> {
    let mut file = File::open(path)?;
    let length = fs::metadata(path)?.len();
    file.seek(SeekFrom::Start(length.saturating_sub(TAIL)))?;
    let mut bytes = Vec::new();
    file.take(TAIL).read_to_end(&mut bytes)?;
    Ok(String::from_utf8_lossy(&bytes).trim().to_owned())
}

/// A path as one word of a command line.
#[must_use]
pub fn quoted(path: &Path) -> String {
    let text = path.display().to_string();
    match cfg!(unix) {
        true => format!("'{}'", text.replace('\'', "'\\''")),
        false => format!("\"{text}\""),
    }
}

#[cfg(all(test, unix))]
mod tests {
    use super::*;

    fn run(command: &str, milliseconds: u64) -> Ended {
        let folder = tempfile::tempdir().expect("a temporary directory");
        let limits = Limits { time: Duration::from_millis(milliseconds), memory: 1 << 30 };
        execute(command, folder.path(), &limits, &Running::default()).expect("sh is there")
    }

    // spec: R6
    #[test]
    fn exit_codes_signals_and_output_are_told() {
        let ended = run("echo good; echo bad >&2; exit 3", 20_000);
        assert_eq!(ended.ending, Ending::Exit(3));
        assert_eq!(ended.said, "good\nbad");
        assert_eq!(run("kill -SEGV $$", 20_000).ending, Ending::Signal(11));
        assert_eq!(run("sh -c 'kill -ABRT $$'; exit $?", 20_000).ending, Ending::Signal(6));
    }

    // spec: R6
    #[test]
    fn a_hang_is_ended_with_all_its_children() {
        let folder = tempfile::tempdir().expect("a temporary directory");
        let limits = Limits { time: Duration::from_millis(300), memory: 1 << 30 };
        let command = "(sleep 2; touch survived) & sleep 60";
        let ended =
            execute(command, folder.path(), &limits, &Running::default()).expect("sh is there");
        assert_eq!(ended.ending, Ending::TimedOut);
        assert!(ended.time < Duration::from_secs(20), "{:?}", ended.time);
        std::thread::sleep(Duration::from_millis(2500));
        assert!(!folder.path().join("survived").exists(), "the child went on");
    }

    // spec: R6
    #[test]
    fn a_busy_loop_is_ended_by_its_processor_time() {
        for command in ["while :; do :; done", "sh -c 'while :; do :; done'; exit $?"] {
            // Five times as long by the clock: what ended it is the limit on processor time.
            let ended = run(command, 1000);
            assert_eq!(ended.ending, Ending::TimedOut, "{command}");
        }
        assert_eq!(run("ulimit -S -t; ulimit -H -t", 2500).said, "3\n6");
    }

    // spec: R6
    #[test]
    fn an_interrupt_ends_what_runs_and_lets_nothing_start() {
        let folder = tempfile::tempdir().expect("a temporary directory");
        let (place, running) = (folder.path().to_owned(), Running::default());
        let limits = Limits { time: Duration::from_secs(60), memory: 1 << 30 };
        let of_thread = running.clone();
        let thread = std::thread::spawn(move || {
            execute("touch begun; sleep 60 & sleep 60", &place, &limits, &of_thread)
        });
        while !folder.path().join("begun").exists() {
            std::thread::sleep(Duration::from_millis(2));
        }
        let start = Instant::now();
        running.end_all();
        // Its folder is gone with it, so there is no output to be told.
        assert!(thread.join().expect("no panic").is_err());
        assert!(start.elapsed() < Duration::from_secs(30));
        assert!(!folder.path().exists());
        let other = tempfile::tempdir().expect("a temporary directory");
        let error = execute("true", other.path(), &limits, &running).expect_err("it is over");
        assert_eq!(error.kind(), io::ErrorKind::Interrupted);
    }

    // spec: R6
    #[cfg(target_os = "linux")]
    #[test]
    fn memory_is_limited() {
        assert_eq!(run("ulimit -v", 20_000).said, (1u64 << 20).to_string());
    }

    #[test]
    fn only_the_end_of_a_long_output_is_kept() {
        let ended = run("i=0; while [ $i -lt 2000 ]; do echo line $i; i=$((i+1)); done", 20_000);
        assert!(ended.said.len() <= TAIL as usize && ended.said.ends_with("line 1999"));
    }

    #[test]
    fn paths_are_one_word_each() {
        assert_eq!(quoted(Path::new("a b")), "'a b'");
        let ended = run(&format!("printf %s {}", quoted(Path::new("it's $HOME"))), 20_000);
        assert_eq!(ended.said, "it's $HOME");
    }
}
