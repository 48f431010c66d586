//! Bytes as files of grids. Shared by the tests and by the targets of `fuzz/`.

#![allow(dead_code)] // each user takes its own part

use std::io::Write;

use trueflight::media::grid_file::{GridChoice, MAX_SAMPLES, Samples, Unreadable, read};

/// Reads bytes as a grid of the given ending; asserts that any result is a grid.
pub fn reads_or_refuses(ending: &str, bytes: &[u8]) -> Option<Samples> {
    let suffix = format!(".{ending}");
    let mut file = tempfile::Builder::new().suffix(&suffix).tempfile().expect("a file");
    file.write_all(bytes).expect("written");
    match read(file.path(), &GridChoice::default()) {
        Ok(samples) => {
            let count = samples.size.iter().product::<usize>();
            assert!(count > 0 && count as u64 <= MAX_SAMPLES);
            assert_eq!(samples.values.len(), count);
            assert!(samples.values.iter().all(|x| x.is_finite() && *x >= 0.0));
            Some(samples)
        }
        Err(Unreadable { message, help }) => {
            assert!(!message.is_empty() && !help.is_empty(), "no words");
            None
        }
    }
}

/// Returns a small valid file of an ending, to be spoilt.
pub fn good(ending: &str) -> Vec<u8> {
    match ending {
        "vdb" => return include_bytes!("../../data/vdb/moved.vdb").to_vec(),
        "nvdb" => return include_bytes!("../../data/grids/mixed-fpN.nvdb").to_vec(),
        "pbrt" => {
            return b"WorldBegin Translate 1 2 3 MakeNamedMedium \"a\" \"string type\" \"uniformgrid\" \"integer nx\" 2 \
                     \"integer ny\" [ 1 ] \"integer nz\" [ 2 ] \"point3 p1\" [ 2 1 4 ] \"float density\" [ 0.5 1 2 .25 ]\n"
                .to_vec();
        }
        _ => {}
    }
    let values = [0.5f32, 1.0, 0.0, 2.0];
    let samples = values.iter().flat_map(|x| x.to_le_bytes());
    if ending == "vol" {
        let mut bytes = b"VOL\x03".to_vec();
        bytes.extend([1i32, 2, 2, 1, 1].iter().flat_map(|n| n.to_le_bytes()));
        bytes.extend([0.0f32, 0.0, 0.0, 1.0, 2.0, 3.0].iter().flat_map(|x| x.to_le_bytes()));
        bytes.extend(samples);
        return bytes;
    }
    let header = "{'descr': '<f4', 'fortran_order': False, 'shape': (1, 2, 2), }";
    let mut bytes = b"\x93NUMPY\x01\x00\x76\x00".to_vec();
    bytes.extend(format!("{header:<117}\n").as_bytes());
    bytes.extend(samples);
    bytes
}
