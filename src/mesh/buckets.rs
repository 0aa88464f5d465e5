//! Things in buckets: what is sorted by a vertex or a face is put beside it first, so that there
//! is little left to sort.

/// Things in buckets, sorted within each.
#[derive(Debug)]
pub(crate) struct Buckets<T> {
    items: Vec<T>,
    ends: Vec<u32>,
}

impl<T: Copy + Default + Ord> Buckets<T> {
    /// Puts `count` things, each of which `get` gives together with its bucket, into so many
    /// `buckets`. O(n log n), but about O(n) as long as buckets are small.
    pub(crate) fn new(count: usize, buckets: usize, get: impl Fn(u32) -> (u32, T)) -> Self {
        let mut ends = vec![0; buckets];
        for i in 0..count as u32 {
            ends[get(i).0 as usize] += 1;
        }
        let mut start = 0;
        for end in &mut ends {
            // Until it is filled, a bucket ends where it starts.
            start += std::mem::replace(end, start);
        }
        let mut items = vec![T::default(); count];
        for i in 0..count as u32 {
            let (bucket, item) = get(i);
            let end = &mut ends[bucket as usize];
            items[*end as usize] = item;
            *end += 1;
        }
        let mut start = 0;
        for &end in &ends {
            items[start..end as usize].sort_unstable();
            start = end as usize;
        }
        Self { items, ends }
    }

    /// What each bucket holds.
    pub(crate) fn iter(&self) -> impl Iterator<Item = &[T]> {
        let starts = std::iter::once(&0).chain(&self.ends);
        starts.zip(&self.ends).map(|(&start, &end)| &self.items[start as usize..end as usize])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn things_are_sorted_by_bucket_and_by_themselves() {
        let thing = |i: u32| (i * 7 % 5, i * 11 % 13);
        let mut sorted: Vec<(u32, u32)> = (0..40).map(thing).collect();
        sorted.sort_unstable();
        let buckets = Buckets::new(40, 6, thing);
        let items: Vec<(u32, u32)> = (0..)
            .zip(buckets.iter())
            .flat_map(|(b, items)| items.iter().map(move |&t| (b, t)))
            .collect();
        assert_eq!(items, sorted);
        assert_eq!(Buckets::new(0, 0, thing).iter().count(), 0);
    }
}
