use super::*;

fn job(rate: &str) -> Job {
    Job(vec![("rate", rate.to_owned()), ("scene", "0123".to_owned())])
}

fn record(name: &str) -> Record {
    Record { picture: name.to_owned(), drops: None, stats: json!({ "drops_drawn": 3 }) }
}

fn written(path: &Path) {
    let interrupt = Interrupt::default();
    let mut journal = Journal::open(path, &job("5"), false, &interrupt).unwrap();
    journal.expose(0.1, &interrupt).unwrap();
    for number in 0..3 {
        journal.record(number, record(&number.to_string()), &interrupt).unwrap();
    }
}

/// A truncated journal has a part of its contents, and never anything else.
#[test]
fn a_journal_that_was_cut_says_less() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("journal");
    written(&path);
    let whole = fs::read(&path).unwrap();
    for length in 0..=whole.len() {
        fs::write(&path, &whole[..length]).unwrap();
        let journal = Journal::open(&path, &job("5"), false, &Interrupt::default()).unwrap();
        let lines = whole[..length].iter().filter(|byte| **byte == b'\n').count();
        assert_eq!(journal.numbers(), (0..lines.saturating_sub(2) as u32).collect::<Vec<_>>());
        let known = journal.exposure().map(f32::to_bits);
        assert_eq!(known, (lines >= 3).then_some(0.1f32.to_bits()), "{length}");
    }
    let journal = Journal::open(&path, &job("5"), false, &Interrupt::default()).unwrap();
    assert_eq!(journal.frame(2), Some(&record("2")));
}

/// A byte that was changed invalidates its line.
#[test]
fn an_edited_line_does_not_count() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("journal");
    written(&path);
    let whole = fs::read(&path).unwrap();
    let second = whole.iter().position(|byte| *byte == b'\n').unwrap() + 1;
    for index in second..whole.len() {
        let mut edited = whole.clone();
        edited[index] ^= 1;
        fs::write(&path, &edited).unwrap();
        let journal = Journal::open(&path, &job("5"), false, &Interrupt::default()).unwrap();
        let numbers = journal.numbers();
        assert!(
            numbers.len() <= 3 && numbers.iter().all(|&n| journal.frame(n) == Some(&record(&n.to_string())))
        );
        let lost = usize::from(journal.exposure().is_none()) + 3 - numbers.len();
        // The end of a line belongs to two.
        assert!(lost == 1 || (lost == 2 && whole[index] == b'\n'), "{index}: {lost} lost");
    }
    let mut edited = whole;
    edited[3] ^= 1;
    fs::write(&path, &edited).unwrap();
    let failure = Journal::open(&path, &job("5"), false, &Interrupt::default()).unwrap_err();
    assert!(failure.code == INPUT && failure.to_string().contains("damaged"), "{failure}");
}

#[test]
fn another_job_is_refused_and_told() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("journal");
    written(&path);
    let failure = Journal::open(&path, &job("6"), false, &Interrupt::default()).unwrap_err();
    let text = failure.to_string();
    assert!(failure.code == INPUT && text.contains("with rate 5, and now it is 6"), "{text}");
    let newer = format!("{{\"downpour_job\":{}}}", VERSION + 1);
    let old = fs::read_to_string(&path).unwrap();
    let rest = old.split_once('\n').unwrap().1;
    fs::write(&path, format!("{} {newer}\n{rest}", check(&newer))).unwrap();
    let failure = Journal::open(&path, &job("5"), false, &Interrupt::default()).unwrap_err();
    assert!(failure.to_string().contains("version 2, this is 1"), "{failure}");
    let journal = Journal::open(&path, &job("6"), true, &Interrupt::default()).unwrap();
    assert_eq!((journal.numbers(), journal.exposure()), (vec![], None));
    journal.close();
    assert!(!path.exists());
}

#[test]
fn two_do_not_work_on_one_clip() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("journal");
    let first = Journal::open(&path, &job("5"), false, &Interrupt::default()).unwrap();
    let failure = Journal::open(&path, &job("5"), true, &Interrupt::default()).unwrap_err();
    assert!(failure.code == FILES && failure.to_string().contains("another downpour"), "{failure}");
    drop(first);
    Journal::open(&path, &job("5"), false, &Interrupt::default()).unwrap();
}

/// A line without an end, and one that is too long, take no more memory than the longest line.
#[test]
fn a_long_journal_is_read_in_pieces() {
    let mut bytes = Vec::new();
    let endless = io::Read::take(io::repeat(b'x'), 1 << 28);
    assert_eq!(next_line(&mut BufReader::new(endless), &mut bytes).unwrap(), None);
    assert!(bytes.capacity() <= 2 * MAX_LINE, "{}", bytes.capacity());

    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("journal");
    written(&path);
    let old = fs::read(&path).unwrap();
    let long = [&vec![b'x'; 3 * MAX_LINE][..], b"\n"].concat();
    let head = old.iter().position(|byte| *byte == b'\n').unwrap() + 1;
    fs::write(&path, [&old[..head], &long, &old[head..], &long[1..long.len() - 1]].concat()).unwrap();
    let journal = Journal::open(&path, &job("5"), false, &Interrupt::default()).unwrap();
    assert_eq!((journal.numbers(), journal.exposure()), (vec![0, 1, 2], Some(0.1)));
    // An incomplete line is removed.
    assert_eq!(fs::metadata(&path).unwrap().len(), (old.len() + long.len()) as u64);
}
