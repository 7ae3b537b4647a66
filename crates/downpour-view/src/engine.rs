//! The thread that draws: it takes the newest question and gives back pictures.

mod drawn;
mod machine;
mod pace;

use std::path::PathBuf;
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::thread::JoinHandle;
use std::time::Duration;

use downpour::Backend;
use downpour::weather::{CameraPose, Weather};

pub use drawn::{Drawn, Histogram, PictureView};
pub use machine::Machine;
pub(crate) use machine::open as open_device;
pub use pace::{Pace, Rest, SCALES};

/// Choice of the device that draws.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct DeviceChoice {
    /// Kind of device.
    pub backend: Backend,
    /// Part of the name of the GPU to take.
    pub adapter: Option<String>,
}

/// Question for a picture.
#[derive(Clone, Debug)]
pub struct Request {
    /// The weather, whose size is replaced by that of the question.
    pub weather: Arc<Weather>,
    /// Revision of the document that it is of.
    pub revision: u64,
    /// Path by which its files are found.
    pub place: PathBuf,
    /// Other folders of files.
    pub asset_roots: Vec<PathBuf>,
    /// The eye; `None` takes the weather's camera.
    pub eye: Option<CameraPose>,
    /// Time, s.
    pub time_s: f64,
    /// Columns and rows.
    pub size: [u32; 2],
    /// Samples along an edge of a pixel.
    pub samples: u32,
    /// True if the exposure is metered anew.
    pub meters: bool,
    /// True if the drops are listed.
    pub lists_drops: bool,
}

/// Reason why there is no picture.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Fault {
    /// Number of the question.
    pub number: u64,
    /// The message, one line.
    pub message: String,
    /// True if the device is gone and did not come back.
    pub is_fatal: bool,
}

/// Answer to a question.
pub type Answer = Result<Arc<Drawn>, Fault>;

/// The thread, from outside.
#[derive(Debug)]
pub struct Engine {
    shared: Arc<Shared>,
    thread: Option<JoinHandle<()>>,
}

#[derive(Default)]
struct Shared {
    state: Mutex<State>,
    asked: Condvar,
    answered: Condvar,
}

impl std::fmt::Debug for Shared {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Shared").finish_non_exhaustive()
    }
}

#[derive(Default)]
struct State {
    /// The newest question, with its number.
    next: Option<(u64, Request)>,
    /// Number of the last question.
    asked: u64,
    /// Number of the last question that was answered.
    answered: u64,
    answer: Option<Answer>,
    is_ended: bool,
    /// Called after each answer.
    wake: Option<Box<dyn Fn() + Send>>,
}

impl Shared {
    fn lock(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Engine {
    /// Starts the thread; the device is opened with the first question.
    ///
    /// # Errors
    /// The system has no thread left.
    pub fn start(choice: DeviceChoice) -> std::io::Result<Self> {
        let shared = Arc::new(Shared::default());
        let other = Arc::clone(&shared);
        let thread = std::thread::Builder::new()
            .name("downpour-view".to_owned())
            .spawn(move || serve(&other, Machine::new(choice)))?;
        Ok(Self { shared, thread: Some(thread) })
    }

    /// Sets what is called after each answer, from the thread.
    pub fn on_answer(&self, wake: impl Fn() + Send + 'static) {
        self.shared.lock().wake = Some(Box::new(wake));
    }

    /// Asks for a picture; a question that has not been begun is dropped. Returns its number.
    pub fn ask(&self, request: Request) -> u64 {
        let mut state = self.shared.lock();
        state.asked += 1;
        let number = state.asked;
        state.next = Some((number, request));
        self.shared.asked.notify_one();
        number
    }

    /// The newest answer, if it was not taken yet.
    #[must_use]
    pub fn take(&self) -> Option<Answer> {
        self.shared.lock().answer.take()
    }

    /// True while a question has no answer.
    #[must_use]
    pub fn is_busy(&self) -> bool {
        let state = self.shared.lock();
        state.answered < state.asked
    }

    /// Waits until all questions are answered. False if that takes longer than a time.
    #[must_use]
    pub fn wait(&self, most: Duration) -> bool {
        let state = self.shared.lock();
        let busy = |state: &mut State| state.answered < state.asked && !state.is_ended;
        let waited = self.shared.answered.wait_timeout_while(state, most, busy);
        let (state, _) = waited.unwrap_or_else(PoisonError::into_inner);
        state.answered >= state.asked
    }
}

impl Drop for Engine {
    fn drop(&mut self) {
        self.shared.lock().is_ended = true;
        self.shared.asked.notify_one();
        if let Some(thread) = self.thread.take() {
            let _ = thread.join();
        }
    }
}

/// Work of the thread.
fn serve(shared: &Shared, mut machine: Machine) {
    loop {
        let mut state = shared.lock();
        let (number, request) = loop {
            if state.is_ended {
                return;
            }
            match state.next.take() {
                Some(next) => break next,
                None => state = shared.asked.wait(state).unwrap_or_else(PoisonError::into_inner),
            }
        };
        drop(state);
        let drawing = std::panic::AssertUnwindSafe(|| machine.draw(number, &request));
        let answer = std::panic::catch_unwind(drawing).unwrap_or_else(|_| {
            machine = Machine::new(machine.choice().clone());
            let message = "internal error while drawing, please report it".to_owned();
            Err(Fault { number, message, is_fatal: false })
        });
        let mut state = shared.lock();
        state.answered = number;
        state.answer = Some(answer);
        if let Some(wake) = &state.wake {
            wake();
        }
        shared.answered.notify_all();
    }
}

#[cfg(test)]
mod tests;
