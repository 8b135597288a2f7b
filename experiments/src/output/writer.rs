//! A thread that writes, so that stepping does not wait for the disk.

use super::netcdf::keep_quiet;
use super::{FileKind, Files, Frame, Header, Moment, Plan, create_files, partial};
use anyhow::{Context, Result, anyhow, ensure};
use std::path::Path;
use std::sync::Mutex;
use std::sync::mpsc::{Receiver, RecvTimeoutError, SyncSender, sync_channel};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

/// Frames that may wait; a frame of a million grains takes half a gigabyte.
const WAITING: usize = 2;

/// How often what was written goes to the disk. A run that is killed loses what came later; one
/// that is killed at that very moment may leave a file that cannot be read. Rows that follow each
/// other fast would be such moments all the time, and a sync costs several times what the row does.
const SYNC_EVERY: Duration = Duration::from_secs(1);

/// Writes frames on a thread of its own.
#[derive(Debug)]
pub struct Writer<F = Frame> {
    frames: Option<SyncSender<F>>,
    thread: Mutex<Option<JoinHandle<Result<()>>>>,
}

impl Writer {
    /// Make the files of `plan` in the folder `dir`; files of these names are replaced, but only
    /// once all new ones are there.
    ///
    /// `phases`: names of the protocol's phases. `grains`: the bed; what never changes
    /// (radius, identity) is taken from it. Unknown names in the plan are refused.
    pub fn create(
        dir: &Path,
        header: &Header,
        plan: &Plan,
        phases: &[String],
        grains: &dem::Grains,
    ) -> Result<Self> {
        Self::start(dir, create_files(dir, header, plan, phases, grains))
    }
}

impl<F: Moment> Writer<F> {
    /// Begin with files that were made in the folder `dir`, as [`partial`] ones, or could not be.
    pub(super) fn start(dir: &Path, files: Result<Files<F>>) -> Result<Self> {
        let files = files
            .and_then(|files| take_places(dir, &files).map(|()| files))
            .inspect_err(|_| remove_partial(dir))?;
        let (frames, waiting) = sync_channel(WAITING);
        let dir = dir.to_path_buf();
        let thread = thread::Builder::new()
            .name("writer".into())
            .spawn(move || write_all(&dir, files, &waiting))?;
        Ok(Self {
            frames: Some(frames),
            thread: Mutex::new(Some(thread)),
        })
    }

    /// Hand over one frame. Waits only if the writer is some frames behind; an error of
    /// the writing thread comes back from a later call, or from [`finish`](Self::finish).
    pub fn send(&self, frame: F) -> Result<()> {
        let frames = self.frames.as_ref().expect("taken only at the end");
        if frames.send(frame).is_ok() {
            return Ok(());
        }
        // The thread ends before its time only because of an error.
        self.join()?;
        Err(anyhow!("output ended after an earlier error"))
    }

    /// Write what is left and close the files.
    pub fn finish(mut self) -> Result<()> {
        self.frames = None;
        self.join()
    }
}

impl<F> Writer<F> {
    /// Wait for the thread and take its error, once.
    fn join(&self) -> Result<()> {
        let mut thread = self.thread.lock().expect("no panic while it is held");
        match thread.take().map(JoinHandle::join) {
            None => Ok(()),
            Some(Ok(result)) => result,
            Some(Err(_)) => Err(anyhow!("the writing thread panicked; files may lack rows")),
        }
    }
}

/// A writer that goes away without being finished still writes what it was given; only
/// its errors are lost.
impl<F> Drop for Writer<F> {
    fn drop(&mut self) {
        self.frames = None;
        let _ = self.join();
    }
}

/// Let the new files take the places of old ones.
fn take_places<F>(dir: &Path, files: &Files<F>) -> Result<()> {
    let paths = || files.iter().map(|(kind, _)| dir.join(kind.file_name()));
    for path in paths() {
        ensure!(!path.is_dir(), "{} is a folder; move it", path.display());
    }
    for path in paths() {
        std::fs::rename(partial(&path), &path)
            .with_context(|| format!("cannot replace {}", path.display()))?;
    }
    Ok(())
}

/// Take away what was made of files that could not all be made.
fn remove_partial(dir: &Path) {
    for kind in FileKind::all() {
        // It may not have come to this one.
        let _ = std::fs::remove_file(partial(&dir.join(kind.file_name())));
    }
}

/// Write frames until the last sender is gone.
fn write_all<F: Moment>(dir: &Path, mut files: Files<F>, frames: &Receiver<F>) -> Result<()> {
    keep_quiet();
    sync(dir, &mut files)?;
    let mut synchronised = Instant::now();
    loop {
        let frame = match frames.recv_timeout(SYNC_EVERY) {
            Ok(frame) => Some(frame),
            Err(RecvTimeoutError::Timeout) => None,
            Err(RecvTimeoutError::Disconnected) => return sync(dir, &mut files),
        };
        for (kind, file) in &mut files {
            let Some(frame) = frame.as_ref().filter(|frame| frame.goes_to(*kind)) else {
                continue;
            };
            file.write(frame).with_context(|| {
                let (path, time) = (dir.join(kind.file_name()), frame.time());
                format!(
                    "cannot write {} at t = {time} s (is there room on the disk?)",
                    path.display()
                )
            })?;
        }
        if synchronised.elapsed() >= SYNC_EVERY {
            sync(dir, &mut files)?;
            synchronised = Instant::now();
        }
    }
}

fn sync<F>(dir: &Path, files: &mut Files<F>) -> Result<()> {
    for (kind, file) in files {
        file.sync().with_context(|| {
            let path = dir.join(kind.file_name());
            format!(
                "cannot write {} (is there room on the disk?)",
                path.display()
            )
        })?;
    }
    Ok(())
}
